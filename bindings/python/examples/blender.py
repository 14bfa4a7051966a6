"""Writes Darboux's tangents into an attribute of every mesh of a Blender file: float vectors "tangent" per corner, and "tangent_sign".

blender model.blend --background --python blender.py    (with darboux installed into Blender's Python)

Blender's UVs run up and its faces wind counter-clockwise, so that fresh tangents are in its convention as they are.
"""

import bpy
import darboux
import numpy as np


def column(items, name, width, dtype=np.float32):
    """A property of all items as an array with a row for each."""
    values = np.empty(len(items) * width, dtype=dtype)
    items.foreach_get(name, values)
    return values.reshape(-1, width)


def write_attribute(mesh, name, kind, member, values):
    """Replaces a corner attribute."""
    if name in mesh.attributes:
        mesh.attributes.remove(mesh.attributes[name])
    mesh.attributes.new(name, kind, "CORNER").data.foreach_set(member, np.ascontiguousarray(values).ravel())


def add_tangents(mesh):
    """Corner tangents for the active UV map; returns how many corners have no usable tangent of their own."""
    if mesh.uv_layers.active is None or not mesh.loops:
        return 0
    vertices = column(mesh.loops, "vertex_index", 1, np.int32).ravel()
    tangents, report = darboux.generate_tangents(
        column(mesh.vertices, "co", 3)[vertices],
        column(mesh.corner_normals, "vector", 3),
        column(mesh.uv_layers.active.uv, "vector", 2),
        faces=column(mesh.polygons, "loop_total", 1, np.int32).ravel(),
        return_report=True,
    )
    write_attribute(mesh, "tangent", "FLOAT_VECTOR", "vector", tangents[:, :3])
    write_attribute(mesh, "tangent_sign", "FLOAT", "value", tangents[:, 3])
    return report.repaired_corners


if __name__ == "__main__":
    for mesh in bpy.data.meshes:
        print(f"{mesh.name}: {len(mesh.loops)} corners, {add_tangents(mesh)} repaired")
    if bpy.data.filepath:
        bpy.ops.wm.save_mainfile()
