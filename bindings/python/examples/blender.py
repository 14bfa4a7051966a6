"""Writes Darboux's tangents into an attribute of every mesh of a Blender file: float vectors "tangent" per corner, and "tangent_sign".

blender model.blend --background --python blender.py    (with darboux installed into Blender's Python)
"""

import bpy
import darboux.bpy

for mesh in bpy.data.meshes:
    if mesh.uv_layers.active is not None:
        found = darboux.bpy.add_tangents(mesh)
        print(f"{mesh.name}: {len(mesh.loops)} corners, {found.cut_faces} faces cut, {found.report.repaired_corners} corners repaired")
if bpy.data.filepath:
    bpy.ops.wm.save_mainfile()
