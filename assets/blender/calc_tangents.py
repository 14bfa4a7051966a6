"""Writes calc_tangents.npz: the arrays of three of Blender's own meshes at their corners, and the tangents that Blender computes from them.

    pip install bpy==5.0.1 && python calc_tangents.py

Of each mesh NAME: NAME_positions, NAME_normals, NAME_uvs, NAME_sizes (the corners of each face), NAME_tangents (with bitangent_sign as w).
"""

import os

import bpy
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
MAKERS = {
    "monkey": lambda: bpy.ops.mesh.primitive_monkey_add(calc_uvs=True),
    "cylinder": lambda: bpy.ops.mesh.primitive_cylinder_add(calc_uvs=True, end_fill_type="TRIFAN"),
    "cube": lambda: bpy.ops.mesh.primitive_cube_add(calc_uvs=True),
}


def column(items, name, width, dtype=np.float32):
    values = np.empty(len(items) * width, dtype)
    items.foreach_get(name, values)
    return values.reshape(-1, width)


def main():
    arrays = {}
    for name, make in MAKERS.items():
        make()
        mesh = bpy.context.object.data
        mesh.polygons.foreach_set("use_smooth", [name == "monkey"] * len(mesh.polygons))
        mesh.update()
        layer = mesh.uv_layers.active
        mesh.calc_tangents(uvmap=layer.name)
        vertices = column(mesh.loops, "vertex_index", 1, np.int32).ravel()
        arrays[f"{name}_positions"] = column(mesh.vertices, "co", 3)[vertices]
        arrays[f"{name}_normals"] = column(mesh.corner_normals, "vector", 3)
        arrays[f"{name}_uvs"] = column(layer.uv, "vector", 2)
        arrays[f"{name}_sizes"] = column(mesh.polygons, "loop_total", 1, np.int32).ravel()
        arrays[f"{name}_tangents"] = np.hstack([column(mesh.loops, "tangent", 3), column(mesh.loops, "bitangent_sign", 1)])
    np.savez_compressed(os.path.join(HERE, "calc_tangents.npz"), **arrays)


main()
