"""Meshes that Pixar's USD and trimesh write, read by nucleus as colliders. The expected positions are those libraries' own:
UsdSkel bakes the skin, and trimesh applies the transforms."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import trimesh
from pxr import Gf, Sdf, Usd, UsdGeom, UsdSkel, Vt

from cache import Cache, Verdicts

nucleus, folder = sys.argv[1], Path(sys.argv[2])
folder.mkdir(parents=True, exist_ok=True)
verdicts = Verdicts()
FRAMES, METRES = 12, 0.01
USD = "USD " + ".".join(str(part) for part in Usd.GetVersion()[1:])
TRIMESH = f"trimesh {trimesh.__version__}"


def read(file, more=""):
    """Positions of a collider at every frame, in scene units."""
    scene = folder / "read.ron"
    scene.write_text(f"""Scene(
        time: (start: 1, end: {FRAMES}, fps: 24),
        nodes: {{
            "nucleus1": nucleus(spaceScale: {METRES}), "shape": mesh(file: "{file}"{more}), "rigid": nRigid(inputMesh: "shape"),
            "speck": nParticle(position0: [(0, 9000, 0)], radius: 0.1),
        }},
    )""")
    run = subprocess.run([nucleus, "-q", "run", "read.ron", "--force", "-o", "read.mcap"], cwd=folder, capture_output=True, text=True)
    if run.returncode != 0:
        raise SystemExit(f"{file}: {run.stdout}{run.stderr}")
    return Cache(str(folder / "read.mcap")).objects["rigid"]["positions"]


def arm(path):
    """A cylinder of rings on three joints that bend and slide, with a blend shape, under a turned root."""
    stage = Usd.Stage.CreateNew(str(path))
    UsdGeom.SetStageMetersPerUnit(stage, METRES)
    UsdGeom.SetStageUpAxis(stage, "Y")
    stage.SetTimeCodesPerSecond(24)
    stage.SetStartTimeCode(1)
    stage.SetEndTimeCode(FRAMES)
    root = UsdSkel.Root.Define(stage, "/figure")
    UsdGeom.Xformable(root).AddRotateXYZOp().Set(Gf.Vec3f(20, 40, -10))
    joints = ["hip", "hip/knee", "hip/knee/foot"]
    rest = [Gf.Matrix4d(1).SetTranslate(Gf.Vec3d(0, 0, 0))] + [Gf.Matrix4d(1).SetTranslate(Gf.Vec3d(0, -4, 0))] * 2
    bind = [Gf.Matrix4d(1).SetTranslate(Gf.Vec3d(0, -4 * k, 0)) for k in range(3)]
    bones = UsdSkel.Skeleton.Define(stage, "/figure/bones")
    bones.CreateJointsAttr(joints)
    bones.CreateBindTransformsAttr(bind)
    bones.CreateRestTransformsAttr(rest)
    motion = UsdSkel.Animation.Define(stage, "/figure/motion")
    motion.CreateJointsAttr(joints)
    motion.CreateBlendShapesAttr(["swell"])
    turns, slides, scales = motion.CreateRotationsAttr(), motion.CreateTranslationsAttr(), motion.CreateScalesAttr()
    weights = motion.CreateBlendShapeWeightsAttr()
    for frame in range(1, FRAMES + 1):
        bent = [Gf.Rotation(Gf.Vec3d(1, 0.3, 0), 4 * frame * (k + 1)).GetQuat() for k in range(3)]
        turns.Set(Vt.QuatfArray([Gf.Quatf(turn) for turn in bent]), frame)
        slides.Set(Vt.Vec3fArray([(0.1 * frame, 0, 0), (0, -4, 0), (0, -4, 0.05 * frame)]), frame)
        scales.Set(Vt.Vec3hArray([(1, 1, 1)] * 3), frame)
        weights.Set([frame / FRAMES], frame)
    points, counts, corners, indices, shares = [], [], [], [], []
    for ring in range(9):
        for spoke in range(8):
            angle = spoke * np.pi / 4
            points.append((np.cos(angle), -ring, np.sin(angle)))
            joint = min(ring // 4, 1)
            indices += [joint, joint + 1]
            shares += [1 - ring % 4 / 4, ring % 4 / 4] if ring < 8 else [0, 1]
            if ring:
                a, b = (ring - 1) * 8 + spoke, (ring - 1) * 8 + (spoke + 1) % 8
                counts.append(4)
                corners += [a, b, b + 8, a + 8]
    mesh = UsdGeom.Mesh.Define(stage, "/figure/leg")
    mesh.CreatePointsAttr(points)
    mesh.CreateFaceVertexCountsAttr(counts)
    mesh.CreateFaceVertexIndicesAttr(corners)
    mesh.CreateSubdivisionSchemeAttr("none")
    shape = UsdSkel.BlendShape.Define(stage, "/figure/leg/swell")
    shape.CreateOffsetsAttr([(0.5, 0, 0)] * 8)
    shape.CreatePointIndicesAttr(list(range(8, 16)))
    binding = UsdSkel.BindingAPI.Apply(mesh.GetPrim())
    binding.CreateSkeletonRel().SetTargets(["/figure/bones"])
    binding.CreateBlendShapesAttr(["swell"])
    binding.CreateBlendShapeTargetsRel().SetTargets(["/figure/leg/swell"])
    binding.CreateJointIndicesPrimvar(False, 2).Set(indices)
    binding.CreateJointWeightsPrimvar(False, 2).Set(shares)
    UsdSkel.BindingAPI.Apply(bones.GetPrim()).CreateAnimationSourceRel().SetTargets(["/figure/motion"])
    UsdSkel.BindingAPI.Apply(root.GetPrim())
    stage.Save()
    return stage


def baked(stage):
    """The points in the world as UsdSkel bakes them."""
    layer = Sdf.Layer.CreateAnonymous("baked.usda")
    layer.TransferContent(stage.Flatten())
    copy = Usd.Stage.Open(layer)
    UsdSkel.BakeSkinning(UsdSkel.Root.Get(copy, "/figure"), Gf.Interval(1, FRAMES))
    mesh = UsdGeom.Mesh.Get(copy, "/figure/leg")
    found = []
    for frame in range(1, FRAMES + 1):
        world = mesh.ComputeLocalToWorldTransform(frame)
        found.append([world.Transform(Gf.Vec3d(point)) for point in mesh.GetPointsAttr().Get(frame)])
    return np.array(found)


for end in ("usda", "usdc"):
    stage = arm(folder / f"arm.{end}")
    verdicts.compare(f"{end}: skin and blend shape read", USD, baked(stage), read(f"arm.{end}"))

over = Usd.Stage.CreateNew(str(folder / "shot.usda"))
UsdGeom.SetStageMetersPerUnit(over, METRES)
over.SetTimeCodesPerSecond(24)
prim = over.DefinePrim("/set/hero")
prim.GetReferences().AddReference("arm.usdc", "/figure")
UsdGeom.Xform.Define(over, "/set").AddTranslateOp().Set(Gf.Vec3d(5, 6, 7))
over.Save()
verdicts.compare("usda: a reference read", USD, baked(stage) + np.array([5, 6, 7]), read("shot.usda", ', object: "hero"'))

box = trimesh.creation.icosphere(subdivisions=2, radius=0.3)
turn = trimesh.transformations.rotation_matrix(0.7, [1, 2, 3], [0.1, 0, 0])
scene = trimesh.Scene()
scene.add_geometry(box, node_name="ball", transform=turn)
scene.export(str(folder / "ball.glb"))
# A glTF is in metres.
moved = trimesh.transform_points(box.vertices, turn) / METRES
verdicts.compare("glb: a node read", TRIMESH, [moved] * FRAMES, read("ball.glb", ', object: "ball"'))
for encoding in ("ascii", "binary"):
    box.export(str(folder / f"{encoding}.ply"), encoding=encoding)
    verdicts.compare(f"{encoding} ply read", TRIMESH, [box.vertices] * FRAMES, read(f"{encoding}.ply"))
verdicts.tell()
