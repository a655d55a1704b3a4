"""Blender as a Python module opens what Blender opens: OBJ, PLY, PC2, MDD, USD and glTF."""

import sys

import bpy
import numpy as np

from cache import Cache, Verdicts, plain

cache_path, folder = sys.argv[1:3]
cache = Cache(cache_path)
verdicts = Verdicts()
frames = [int(at) for at in cache.at]
READER = f"Blender {bpy.app.version_string}"


def empty():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.fps = round(cache.fps)
    scene.render.fps_base = round(cache.fps) / cache.fps


def evaluated(thing):
    graph = bpy.context.evaluated_depsgraph_get()
    mesh = thing.evaluated_get(graph).to_mesh()
    return corners(mesh)


def corners(mesh):
    flat = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", flat)
    return flat.reshape(-1, 3)


def faces(mesh):
    return [list(polygon.vertices) for polygon in mesh.polygons]


def import_obj(path):
    bpy.ops.wm.obj_import(filepath=path, forward_axis="Y", up_axis="Z", validate_meshes=False)
    return bpy.context.selected_objects[0]


def used_points(known):
    """Blender leaves out points that no face names, when it reads OBJ and glTF."""
    return sorted({point for face in known["faces"] for point in face}) or list(range(known["points"]))


def sequence(end, open_file):
    for name, known in cache.objects.items():
        found = []
        for frame in frames:
            empty()
            thing = open_file(f"{folder}/{end}/{plain(name)}.{frame:04}.{end}")
            found.append(corners(thing.data))
        kept = used_points(known) if end == "obj" else slice(None)
        verdicts.compare(f"{end} {name}", READER, known["positions"][:, kept], found)
        verdicts.same(f"{end} {name}: faces", READER, known["faces"], faces(thing.data))


def import_ply(path):
    bpy.ops.wm.ply_import(filepath=path, forward_axis="Y", up_axis="Z")
    return bpy.context.selected_objects[0]


def point_cache(end, kind):
    for name, known in cache.objects.items():
        empty()
        is_whole = len(used_points(known)) == known["points"]
        mesh = f"{end}/{plain(name)}.obj" if is_whole else f"ply/{plain(name)}.{frames[0]:04}.ply"
        thing = (import_obj if is_whole else import_ply)(f"{folder}/{mesh}")
        modifier = thing.modifiers.new("cache", "MESH_CACHE")
        modifier.cache_format = kind
        modifier.filepath = f"{folder}/{end}/{plain(name)}.{end}"
        # The file's own time: in frames for PC2, in seconds for MDD.
        modifier.time_mode = "FRAME"
        modifier.play_mode = "SCENE"
        modifier.frame_start = frames[0]
        found = []
        for frame in frames:
            bpy.context.scene.frame_set(frame)
            found.append(evaluated(thing))
        verdicts.compare(f"{end} {name}", READER, known["positions"], found)


def usd():
    empty()
    bpy.ops.wm.usd_import(filepath=f"{folder}/run.usda", set_frame_range=True, apply_unit_conversion_scale=False)
    scene = bpy.context.scene
    verdicts.same("usda: frames", READER, (frames[0], frames[-1]), (scene.frame_start, scene.frame_end))
    for name, known in cache.objects.items():
        if known["kind"] == "particles":
            continue  # a point cloud that Blender shows, but does not give out through this door
        prim = plain(name, True)
        thing = next(t for t in bpy.data.objects if t.name == prim or t.data and t.data.name == prim)
        found = []
        for frame in frames:
            scene.frame_set(frame)
            found.append(evaluated(thing))
        verdicts.compare(f"usda {name}", READER, known["positions"], found)
        verdicts.same(f"usda {name}: faces", READER, known["faces"], faces(thing.data))


def gltf():
    empty()
    bpy.ops.import_scene.gltf(filepath=f"{folder}/run.glb", merge_vertices=False)
    for name, known in cache.objects.items():
        thing = next(t for t in bpy.data.objects if t.name == name)
        found = []
        for frame in frames:
            # glTF counts seconds from its first sample; Blender puts second 0 at frame 0.
            bpy.context.scene.frame_set(frame - frames[0])
            found.append(evaluated(thing))
        # Blender turns glTF's y-up into its z-up.
        turned = [np.stack([p[:, 0], p[:, 2], -p[:, 1]], axis=1) for p in found]
        expected = known["positions"][:, used_points(known)].astype(np.float64) / cache.units
        verdicts.compare(f"glb {name}", READER, expected, turned)


sequence("obj", import_obj)
sequence("ply", import_ply)
point_cache("pc2", "PC2")
point_cache("mdd", "MDD")
usd()
gltf()
verdicts.tell()
