"""Pixar's USD with its validators, and VTK; and a walk through Maya's nCache, for which there is no reader but Maya."""

import struct
import sys
import xml.etree.ElementTree as xml

import numpy as np
import vtk
from pxr import Usd, UsdGeom, UsdValidation
from vtk.util.numpy_support import vtk_to_numpy

from cache import Cache, Verdicts, plain

cache_path, folder = sys.argv[1:3]
cache = Cache(cache_path)
verdicts = Verdicts()
frames = [int(at) for at in cache.at]
USD = "USD " + ".".join(str(part) for part in Usd.GetVersion()[1:])
VTK = "VTK " + vtk.vtkVersion().GetVTKVersion()


def usd(end):
    stage = Usd.Stage.Open(f"{folder}/run.{end}")
    verdicts.same(f"{end}: units", USD, 1 / cache.units, UsdGeom.GetStageMetersPerUnit(stage))
    verdicts.same(f"{end}: up", USD, "Y", UsdGeom.GetStageUpAxis(stage))
    times = (stage.GetStartTimeCode(), stage.GetEndTimeCode(), stage.GetTimeCodesPerSecond())
    verdicts.same(f"{end}: times", USD, (cache.at[0], cache.at[-1], cache.fps), times)
    for name, known in cache.objects.items():
        prim = stage.GetPrimAtPath(f"/run/{plain(name, True)}")
        points = UsdGeom.PointBased(prim)
        found = [np.array(points.GetPointsAttr().Get(at)) for at in cache.at]
        verdicts.compare(f"{end} {name}", USD, known["positions"], found)
        if known["faces"]:
            mesh = UsdGeom.Mesh(prim)
            counts, corners = mesh.GetFaceVertexCountsAttr().Get(), mesh.GetFaceVertexIndicesAttr().Get()
            flat = [corner for face in known["faces"] for corner in face]
            verdicts.same(f"{end} {name}: faces", USD, ([len(f) for f in known["faces"]], flat), (list(counts), list(corners)))
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    errors = UsdValidation.ValidationContext(validators).Validate(stage)
    verdicts.same(f"{end}: {len(validators)} validators", USD, [], [error.GetMessage() for error in errors])


def grids():
    for name, known in cache.objects.items():
        found = []
        for frame in frames:
            reader = vtk.vtkXMLUnstructuredGridReader()
            reader.SetFileName(f"{folder}/vtu/{plain(name)}.{frame:04}.vtu")
            reader.Update()
            grid = reader.GetOutput()
            found.append(vtk_to_numpy(grid.GetPoints().GetData()))
        verdicts.compare(f"vtu {name}", VTK, known["positions"], found)
        cells = [[grid.GetCell(k).GetPointId(j) for j in range(grid.GetCell(k).GetNumberOfPoints())]
                 for k in range(grid.GetNumberOfCells())]
        verdicts.same(f"vtu {name}: cells", VTK, known["faces"] or [[k] for k in range(known["points"])], cells)
        sets = xml.parse(f"{folder}/vtu/{plain(name)}.pvd").findall("Collection/DataSet")
        times = [float(entry.get("timestep")) for entry in sets]
        verdicts.compare(f"pvd {name}: times", "XML", [at / cache.fps for at in cache.at], times)


def plys():
    for name, known in cache.objects.items():
        found = []
        for frame in frames:
            reader = vtk.vtkPLYReader()
            reader.SetFileName(f"{folder}/ply/{plain(name)}.{frame:04}.ply")
            reader.Update()
            found.append(vtk_to_numpy(reader.GetOutput().GetPoints().GetData()))
        verdicts.compare(f"ply {name}", VTK, known["positions"], found)


def walk(data, wide):
    """Tag and data of every block of an nCache, groups opened."""
    at, step = 0, 8 if wide else 4
    while at < len(data):
        tag = data[at:at + 4]
        head = ">4xQ" if wide else ">I"
        (length,) = struct.unpack_from(head, data, at + 4)
        at += 4 + struct.calcsize(head)
        body = data[at:at + length]
        if tag in (b"FOR4", b"FOR8"):
            yield from walk(body[4:], wide)
            at += length
        else:
            yield tag, body
            at += -(-length // step) * step


def ncache(end):
    reader = "a walk of our own"
    for name, known in cache.objects.items():
        node = plain(name, True)
        channels = [c.attrib for c in xml.parse(f"{folder}/{end}/{node}.xml").find("Channels")]
        wanted = node if known["faces"] else f"{node}_position"
        verdicts.same(f"{end} {name}: channel", reader, True, any(c["ChannelName"] == wanted for c in channels))
        found = []
        for frame in frames:
            with open(f"{folder}/{end}/{node}Frame{frame}.{end}", "rb") as file:
                blocks = list(walk(file.read(), end == "mcx"))
            place = blocks.index((b"CHNM", wanted.encode() + b"\0"))
            assert blocks[1][0] == b"STIM" and struct.unpack(">i", blocks[1][1])[0] == round(frame * 6000 / cache.fps)
            assert blocks[place + 1] == (b"SIZE", struct.pack(">I", known["points"]))
            found.append(np.frombuffer(blocks[place + 2][1], ">f4").reshape(-1, 3))
        verdicts.compare(f"{end} {name}", reader, known["positions"], found)


usd("usda")
usd("usdc")
grids()
plys()
ncache("mc")
ncache("mcx")
verdicts.tell()
