"""Foxglove's own message types read the MCAP file for viewers; rerun converts it."""

import subprocess
import sys

import numpy as np
from google.protobuf import descriptor_pb2
from foxglove_schemas_protobuf.PointCloud_pb2 import PointCloud
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

from cache import Cache, Verdicts

cache_path, folder = sys.argv[1:3]
cache = Cache(cache_path)
verdicts = Verdicts()
path = f"{folder}/run.foxglove.mcap"


def described(file, into):
    """All message types of a file and of those it builds on: name, number, kind and type of each field."""
    for needed in file.dependencies:
        described(needed, into)
    proto = descriptor_pb2.FileDescriptorProto()
    file.CopyToProto(proto)
    note(proto, into)


def note(proto, into):
    for message in proto.message_type:
        fields = {(f.name, f.number, f.type, f.label, f.type_name) for f in message.field}
        enums = {(e.name, tuple((v.name, v.number) for v in e.value)) for e in message.enum_type}
        into[f"{proto.package}.{message.name}"] = (fields, enums)


def schemas(reader):
    theirs = {}
    described(SceneUpdate.DESCRIPTOR.file, theirs)
    described(PointCloud.DESCRIPTOR.file, theirs)
    for schema in reader.get_summary().schemas.values():
        ours = {}
        for proto in descriptor_pb2.FileDescriptorSet.FromString(schema.data).file:
            note(proto, ours)
        verdicts.same(f"foxglove schema {schema.name}", "Foxglove's types", theirs, ours)


with open(path, "rb") as file:
    schemas(make_reader(file))

meshes, clouds, indices = {}, {}, {}
with open(path, "rb") as file:
    # Decoded once by the schema in the file, and once by Foxglove's own types.
    for _, channel, message, decoded in make_reader(file, decoder_factories=[DecoderFactory()]).iter_decoded_messages():
        name = channel.topic.removeprefix("/").rsplit("/", 1)[0]
        if channel.topic.endswith("/mesh"):
            entity = SceneUpdate.FromString(message.data).entities[0]
            triangles = entity.triangles[0]
            assert entity.id == name and triangles.pose.orientation.w > 0.7
            assert list(decoded.entities[0].triangles[0].indices) == list(triangles.indices)
            meshes.setdefault(name, []).append([(p.x, p.y, p.z) for p in triangles.points])
            indices[name] = list(triangles.indices)
        else:
            cloud = PointCloud.FromString(message.data)
            assert [f.name for f in cloud.fields] == ["x", "y", "z"] and cloud.point_stride == 12
            clouds.setdefault(name, []).append(np.frombuffer(cloud.data, "<f4").reshape(-1, 3))

for name, known in cache.objects.items():
    expected = known["positions"].astype(np.float64) / cache.units
    verdicts.compare(f"foxglove {name}: points", "Foxglove's types", expected, clouds[name])
    if known["faces"]:
        verdicts.compare(f"foxglove {name}: mesh", "Foxglove's types", expected, meshes[name])
        fan = [c for f in known["faces"] for k in range(2, len(f)) for c in (f[0], f[k - 1], f[k])]
        verdicts.same(f"foxglove {name}: triangles", "Foxglove's types", fan, indices[name])

import rerun

VERSION = f"rerun {rerun.__version__}"
done = subprocess.run([sys.executable, "-m", "rerun", "mcap", "convert", path, "-o", f"{folder}/run.rrd"],
                      capture_output=True, text=True)
verdicts.same("foxglove: converted", VERSION, 0, done.returncode)
if done.returncode:
    print(done.stderr, file=sys.stderr)
else:
    told = subprocess.run([sys.executable, "-m", "rerun", "rrd", "print", "-vvv", f"{folder}/run.rrd"],
                          capture_output=True, text=True).stdout
    verdicts.same("foxglove: clouds become points", VERSION, True, "Points3D:positions" in told)
verdicts.tell()
