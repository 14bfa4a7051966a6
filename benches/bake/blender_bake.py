"""Bakes a pair of meshes with Blender's Cycles (package bpy): tangent space, selected to active, from a cage, on the processor.

python blender_bake.py FOLDER SIZE SAMPLES THREADS

FOLDER holds low.mesh, cage.mesh and high.mesh: the numbers of vertices and triangles as u32, then positions (3 floats per vertex), normals (3),
UVs (2, v points down), and three u32 per triangle, all little-endian. The map is written into it as map.f32: red, green and blue from 0 to 1
as floats, from the upper left corner. The last line printed is the time that the bake took, in seconds, without the making of the meshes.
"""

import sys
import time
from pathlib import Path

import bpy
import numpy as np


def read(path):
    data = path.read_bytes()
    vertices, triangles = np.frombuffer(data, "<u4", 2)
    at = 8
    arrays = []
    for kind, count in [("<f4", 3 * vertices), ("<f4", 3 * vertices), ("<f4", 2 * vertices), ("<u4", 3 * triangles)]:
        arrays.append(np.frombuffer(data, kind, count, at))
        at += 4 * int(count)
    return arrays


def build(path):
    """An object with the mesh of a file."""
    positions, normals, uvs, indices = read(path)
    mesh = bpy.data.meshes.new(path.stem)
    triangles = len(indices) // 3
    mesh.vertices.add(len(positions) // 3)
    mesh.vertices.foreach_set("co", positions)
    mesh.loops.add(len(indices))
    mesh.loops.foreach_set("vertex_index", indices)
    mesh.polygons.add(triangles)
    mesh.polygons.foreach_set("loop_start", np.arange(0, 3 * triangles, 3, dtype=np.int32))
    mesh.polygons.foreach_set("use_smooth", np.ones(triangles, dtype=bool))
    layer = mesh.uv_layers.new(name="UVMap")
    flipped = np.stack([uvs[0::2], 1.0 - uvs[1::2]], axis=1)
    layer.data.foreach_set("uv", flipped[indices].ravel())
    # Free custom normals, as floats per vertex. normals_split_custom_set keeps 16 bits per corner.
    mesh.attributes.new("custom_normal", "FLOAT_VECTOR", "POINT").data.foreach_set("vector", normals)
    mesh.update(calc_edges=True)
    kept = np.empty(3 * len(indices), dtype=np.float32)
    mesh.corner_normals.foreach_get("vector", kept)
    expected = normals.reshape(-1, 3)[indices].ravel()
    if np.abs(kept - expected).max() > 1e-6:
        raise SystemExit(f"{path.name}: Blender has other normals, by up to {np.abs(kept - expected).max()}")
    item = bpy.data.objects.new(path.stem, mesh)
    bpy.context.scene.collection.objects.link(item)
    return item


def prepare(folder, size, samples, threads):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.threads_mode = "FIXED"
    scene.render.threads = threads
    scene.cycles.device = "CPU"
    scene.cycles.samples = samples
    scene.cycles.use_adaptive_sampling = False
    scene.cycles.use_denoising = False
    low, cage, high = (build(folder / f"{name}.mesh") for name in ["low", "cage", "high"])
    image = bpy.data.images.new("map", size, size, float_buffer=True, is_data=True)
    material = bpy.data.materials.new("material")
    material.use_nodes = True
    node = material.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    material.node_tree.nodes.active = node
    low.data.materials.append(material)
    cage.hide_render = True
    high.select_set(True)
    low.select_set(True)
    bpy.context.view_layer.objects.active = low
    bpy.context.view_layer.update()
    return image


def main():
    folder = Path(sys.argv[1])
    size, samples, threads = (int(word) for word in sys.argv[2:5])
    bpy.ops.wm.read_factory_settings(use_empty=True)
    image = prepare(folder, size, samples, threads)
    start = time.perf_counter()
    bpy.ops.object.bake(
        type="NORMAL", normal_space="TANGENT", use_selected_to_active=True, use_cage=True, cage_object="cage", margin=16
    )
    seconds = time.perf_counter() - start
    pixels = np.empty(4 * size * size, dtype=np.float32)
    image.pixels.foreach_get(pixels)
    rows = pixels.reshape(size, size, 4)[::-1, :, :3]
    (folder / "map.f32").write_bytes(np.ascontiguousarray(rows).astype("<f4").tobytes())
    print(f"{seconds:.3f}", flush=True)


main()
