# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
"""Prints the cameras of a glTF file as Blender has them, as JSON: center and viewing direction (y up) by name, the
vertical field of view, and the centers of the moving camera at its keys.
blender --background --python-exit-code 1 --python blender_cameras.py -- FILE.glb"""
import json
import math
import sys

import bpy
import numpy

numpy.bool = bool  # Blender 3.4 reads the name that NumPy 1.24 removed


def in_gltf(v):
    """Returns a vector with glTF's y up; Blender's z is up."""
    return [v[0], v[2], -v[1]]


bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.gltf(filepath=sys.argv[-1])
scene = bpy.context.scene
cameras = {one.name: one for one in bpy.data.objects if one.type == "CAMERA"}
moving = cameras["moving camera"]
path = []
for key in moving.animation_data.action.fcurves[0].keyframe_points:
    scene.frame_set(math.floor(key.co.x), subframe=key.co.x % 1)
    path.append(in_gltf(moving.matrix_world.translation))
print("CAMERAS " + json.dumps({
    "centers": {name: in_gltf(one.matrix_world.translation) for name, one in cameras.items()},
    "directions": {name: in_gltf(-one.matrix_world.col[2]) for name, one in cameras.items()},
    "yfov_rad": moving.data.angle_y,
    "path": path,
    "images": len(bpy.data.images),
}))
