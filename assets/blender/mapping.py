"""Writes mapping.fbx and mapping.glb: plates whose textures are moved, turned, scaled and clamped by Blender's Mapping nodes.

    pip install bpy==5.0.1 && python mapping.py

Blender's exporters turn each Mapping node into their format's own numbers, so that the two files can be compared.
"""

import os
import sys

import bpy
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))

# Of each plate: location, angle in radians, scale, extension. Blender's Mapping node for textures undoes them.
PLATES = {
    "plain": ((0, 0), 0, (1, 1), "REPEAT"),
    "moved": ((0.25, 0.5), 0, (1, 1), "REPEAT"),
    "scaled": ((0, 0), 0, (0.5, 0.25), "REPEAT"),
    "moved and scaled": ((0.25, 0.125), 0, (0.5, 0.25), "REPEAT"),
    "turned": ((0, 0), 0.5, (1, 1), "REPEAT"),
    "all": ((0.25, -0.5), 0.75, (0.5, 0.5), "REPEAT"),
    "mirrored": ((0, 0), 0, (-1, 1), "REPEAT"),
    "clamped": ((0, 0), 0, (1, 1), "EXTEND"),
}


def plate(name, place, image, location, angle, scale, extension):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([(x + 2 * place, y, 0) for x, y in [(0, 0), (1, 0), (1, 1), (0, 1)]], [], [(0, 1, 2, 3)])
    uvs = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], np.float32)
    mesh.uv_layers.new(name="UVMap").uv.foreach_set("vector", uvs.ravel())
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    nodes, links = made.node_tree.nodes, made.node_tree.links
    texture = nodes.new("ShaderNodeTexImage")
    texture.image, texture.extension = image, extension
    links.new(texture.outputs["Color"], nodes["Principled BSDF"].inputs["Base Color"])
    coordinates, mapping = nodes.new("ShaderNodeTexCoord"), nodes.new("ShaderNodeMapping")
    mapping.vector_type = "TEXTURE"
    mapping.inputs["Location"].default_value = (*location, 0)
    mapping.inputs["Rotation"].default_value = (0, 0, angle)
    mapping.inputs["Scale"].default_value = (*scale, 1)
    links.new(coordinates.outputs["UV"], mapping.inputs["Vector"])
    links.new(mapping.outputs["Vector"], texture.inputs["Vector"])
    mesh.materials.append(made)
    bpy.context.scene.collection.objects.link(bpy.data.objects.new(name, mesh))


if __name__ == "__main__":
    folder = sys.argv[1] if len(sys.argv) > 1 else HERE
    bpy.ops.wm.read_factory_settings(use_empty=True)
    image = bpy.data.images.load(os.path.join(HERE, "scene_normal.png"))
    for place, (name, values) in enumerate(PLATES.items()):
        plate(name, place, image, *values)
    bpy.context.view_layer.update()
    bpy.ops.export_scene.fbx(filepath=os.path.join(folder, "mapping.fbx"), bake_anim=False, path_mode="RELATIVE")
    bpy.ops.export_scene.gltf(filepath=os.path.join(folder, "mapping.glb"), export_animations=False)
