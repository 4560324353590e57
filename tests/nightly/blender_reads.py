"""Blender imports a run's exports, without a window and without drawing anything.

usage: blender --background --factory-startup --python-exit-code 1 --python blender_reads.py -- RUN

RUN is a run folder with ribbon.glb, ribbon_rest.obj, ribbon.pc2 and frames/*.vtp. The clip of the GLB must have a shape
key for every frame after the first and end in the last frame; the point cache, through Blender's Mesh Cache modifier on
the imported OBJ, must give the points of the cache at every frame; both counts must be those of the VTP files.
"""

import struct
import sys
from pathlib import Path

import bpy
import numpy

numpy.bool = bool  # the importer of Debian 12's Blender 3.4 asks for the name that Debian 12's NumPy has dropped

run = Path(sys.argv[sys.argv.index("--") + 1]).resolve()


def check(condition, message):
    if not condition:
        raise SystemExit(f"{run}: {message}")


def cache():
    """Frames of the point cache: lists of points."""
    data = (run / "ribbon.pc2").read_bytes()
    points, samples = struct.unpack("<i", data[16:20])[0], struct.unpack("<i", data[28:32])[0]
    numbers = list(struct.iter_unpack("<3f", data[32:]))
    return [numbers[k * points:(k + 1) * points] for k in range(samples)]


def farthest(found, expected):
    check(len(found) == len(expected), f"{len(found)} points where {len(expected)} were expected")
    return max(abs(a - b) for p, q in zip(found, expected) for a, b in zip(p, q))


def evaluated(item, frame):
    """The points of an object at a frame, as Blender's world has them."""
    bpy.context.scene.frame_set(frame)
    shown = item.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return [tuple(shown.matrix_world @ vertex.co) for vertex in shown.to_mesh().vertices]


def imported(call, **options):
    before = set(bpy.data.objects)
    call(**options)
    return [item for item in bpy.data.objects if item not in before and item.type == "MESH"]


frames = cache()
size = max(abs(x) for point in frames[-1] for x in point)
tolerance = 1e-5 * size
check(len(list((run / "frames").glob("*.vtp"))) == len(frames), "the cache has other frames than the VTP files")

(strip,) = (item for item in imported(bpy.ops.import_scene.gltf, filepath=str(run / "ribbon.glb")) if item.data.shape_keys)
keys = strip.data.shape_keys
check(len(keys.key_blocks) == len(frames), f"{len(keys.key_blocks)} shapes in the GLB, {len(frames)} frames")
last = int(round(keys.animation_data.action.frame_range[1])) if keys.animation_data.action else \
    int(round(max(s.action_frame_end for track in keys.animation_data.nla_tracks for s in track.strips)))
error = farthest(evaluated(strip, last), frames[-1])
check(error < tolerance, f"the GLB's last frame is off by {error:g} m")

(rest,) = imported(bpy.ops.wm.obj_import, filepath=str(run / "ribbon_rest.obj"), forward_axis="Y", up_axis="Z")
modifier = rest.modifiers.new("cache", "MESH_CACHE")
modifier.cache_format, modifier.filepath = "PC2", str(run / "ribbon.pc2")
modifier.frame_start = 0
worst = max(farthest(evaluated(rest, k), points) for k, points in enumerate(frames))
check(worst < tolerance, f"the point cache is off by {worst:g} m")
print(f"{run.name}: {len(frames)} frames of {len(frames[0])} points; the GLB ends {error:.1e} m from the last, "
      f"the point cache is nowhere more than {worst:.1e} m off")
