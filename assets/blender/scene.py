"""Writes one scene in every format that Blender exports: scene.fbx, .obj, .ply, .stl, .usda, .usdc, .usdz, .glb and .z-up.glb.

    pip install bpy==5.0.1 && python scene.py

The scene has quads, triangles, hexagons and concave octagons, two UV sets, a texture that is mirrored in the middle, two shape keys, an
armature, a material with a normal map, and two instances of one mesh, one of them mirrored by its scale.

Quads are longer in UV space from their second to their fourth corner, so that MikkTSpace cuts them as Blender does for glTF, from the first
to the third.

Positions and UVs are multiples of 1/64, so that 1 - v and six decimals are exact. Normals are those that the rounding of Blender's glTF
exporter (four decimals, then unit length) leaves as they are. Formats that keep floats therefore have the same bits: OBJ those of
scene.glb, whose vertices are turned to y up, FBX and USD those of scene.z-up.glb, whose vertices stay as they are in Blender.
"""

import os
import sys

import bpy
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
COLUMNS, ROWS = 8, 5


def exact(value):
    return round(float(value) * 64) / 64


def rounded_normal(normal):
    """A unit normal near the given one that the exporter's steps do not change: four decimals, then twice unit length, summed by numpy."""

    def unit(vector):
        return vector / np.linalg.norm(vector[None], axis=1)

    normal = np.asarray(normal, np.float32)
    for step in range(100):
        rounded = np.round(unit(normal + np.float32([step * 1e-4, 0, 0])), 4) + 0  # -0 becomes 0
        found = unit(rounded)
        if (np.round(found, 4) == rounded).all() and (unit(found) == found).all():
            return found
    raise ValueError(f"no such normal near {normal}")


def sheet_faces():
    """Quads of a grid. Some are cut into triangles, pairs are joined to hexagons, and blocks of four to a concave octagon and a quad."""

    def at(column, row):
        return row * (COLUMNS + 1) + column

    faces, joined = [], set()
    for column in (1, 6):
        ring = [(0, 0), (1, 0), (1, 1), (1, 2), (0, 2), (0, 1)]
        faces.append(tuple(at(column + x, 1 + y) for x, y in ring))
        joined |= {(column, 1), (column, 2)}
    for column in (2, 4):
        ring = [(0, 0), (1, 0), (2, 0), (2, 1), (2, 2), (1, 1), (0, 2), (0, 1)]
        faces.append(tuple(at(column + x, 3 + y) for x, y in ring))
        faces.append(tuple(at(column + x, 3 + y) for x, y in [(1, 1), (2, 2), (1, 2), (0, 2)]))
        joined |= {(column + x, 3 + y) for x in (0, 1) for y in (0, 1)}
    for row in range(ROWS):
        for column in range(COLUMNS):
            if (column, row) in joined:
                continue
            a, b, c, d = (at(column + x, row + y) for x, y in [(0, 0), (1, 0), (1, 1), (0, 1)])
            faces.extend([(a, b, c), (a, c, d)] if (row + column) % 5 == 0 else [(a, b, c, d)])
    return faces


def sheet():
    """A wavy sheet of 8 by 5 cells. Its first UV set is mirrored in the middle, its second is not."""
    points = [(exact(x / 4 - 1), exact(y / 4 - 0.5)) for y in range(ROWS + 1) for x in range(COLUMNS + 1)]
    heights = [exact(0.2 * np.sin(3 * x) * np.cos(2 * y)) for x, y in points]
    mesh = bpy.data.meshes.new("Sheet")
    mesh.from_pydata([(x, y, z) for (x, y), z in zip(points, heights)], [], sheet_faces())
    corners = [loop.vertex_index for loop in mesh.loops]
    for name, uv_of in [
        ("UVMap", lambda x, y: (abs(x) * 0.75 + 0.125, y * 0.5 - x * 0.25 + 0.5)),
        ("Detail", lambda x, y: (y * 0.5 + 0.25, x * 0.5 + 0.5)),
    ]:
        uvs = [tuple(map(exact, uv_of(*points[corner]))) for corner in corners]
        mesh.uv_layers.new(name=name).uv.foreach_set("vector", np.array(uvs, np.float32).ravel())
    slopes = [(-0.6 * np.cos(3 * x) * np.cos(2 * y), 0.4 * np.sin(3 * x) * np.sin(2 * y), 1) for x, y in points]
    normals = [rounded_normal(slope / np.linalg.norm(slope)) for slope in slopes]
    set_normals(mesh, [normals[corner] for corner in corners])
    return mesh


def block():
    """A box without its lower side, with hard edges."""
    positions = [(x, y, z) for z in (-0.25, 0.25) for y in (-0.5, 0.5) for x in (-0.25, 0.25)]
    faces = [(4, 5, 7, 6), (0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6)]
    mesh = bpy.data.meshes.new("Block")
    mesh.from_pydata(positions, [], faces)
    square = [(0.0, 0.0), (0.5, 0.0), (0.5, 1.0), (0.0, 1.0)]
    mesh.uv_layers.new(name="UVMap").uv.foreach_set("vector", np.array(square * len(faces), np.float32).ravel())
    normals = [(0, 0, 1), (0, -1, 0), (1, 0, 0), (0, 1, 0), (-1, 0, 0)]
    set_normals(mesh, [normal for normal in normals for _ in range(4)])
    return mesh


def set_normals(mesh, normals):
    layer = mesh.attributes.new("custom_normal", "FLOAT_VECTOR", "CORNER")
    layer.data.foreach_set("vector", np.array(normals, np.float32).ravel())
    mesh.update()


def normal_map():
    """A bump in the middle of 16 by 16 texels, green up as in OpenGL."""
    size = 16
    row, column = np.mgrid[0:size, 0:size] - (size - 1) / 2
    slope = 0.12 * np.exp(-(row**2 + column**2) / 20)
    normals = np.stack([slope * column, slope * row, np.ones((size, size))], -1)
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    image = bpy.data.images.new("scene_normal", size, size, is_data=True)
    texels = np.ones((size, size, 4), np.float32)
    texels[..., :3] = normals * 0.5 + 0.5
    image.pixels.foreach_set(texels.ravel())
    image.filepath_raw = os.path.join(HERE, "scene_normal.png")
    image.file_format = "PNG"
    image.save()
    image.source = "FILE"
    return image


def material(image):
    made = bpy.data.materials.new("Scales")
    made.use_nodes = True
    nodes, links = made.node_tree.nodes, made.node_tree.links
    principled = nodes["Principled BSDF"]
    principled.inputs["Base Color"].default_value = (0.25, 0.5, 0.75, 1)
    principled.inputs["Roughness"].default_value = 0.75
    principled.inputs["Metallic"].default_value = 0.25
    texture, normal = nodes.new("ShaderNodeTexImage"), nodes.new("ShaderNodeNormalMap")
    texture.image = image
    normal.uv_map = "UVMap"
    links.new(texture.outputs["Color"], normal.inputs["Color"])
    links.new(normal.outputs["Normal"], principled.inputs["Normal"])
    return made


def armature():
    data = bpy.data.armatures.new("Bones")
    owner = bpy.data.objects.new("Armature", data)
    bpy.context.scene.collection.objects.link(owner)
    bpy.context.view_layer.objects.active = owner
    bpy.ops.object.mode_set(mode="EDIT")
    left, right = data.edit_bones.new("Left"), data.edit_bones.new("Right")
    left.head, left.tail = (-1, 0, 0), (0, 0, 0)
    right.head, right.tail = (0, 0, 0), (1, 0, 0)
    right.parent = left
    bpy.ops.object.mode_set(mode="OBJECT")
    return owner


def build():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    link = bpy.context.scene.collection.objects.link
    scales, owner = material(normal_map()), armature()
    mesh = sheet()
    mesh.materials.append(scales)
    body = bpy.data.objects.new("Body", mesh)
    link(body)
    for name, offset in [("Basis", None), ("Bulge", (0, 0, 0.25)), ("Shear", (0.125, 0, 0))]:
        key = body.shape_key_add(name=name, from_mix=False)
        key.value = 0
        for point in key.data if offset else ():
            weight = exact(1 - abs(point.co.x))
            point.co = [exact(x + weight * move) for x, move in zip(point.co, offset)]
    left, right = body.vertex_groups.new(name="Left"), body.vertex_groups.new(name="Right")
    for vertex in mesh.vertices:
        weight = exact((vertex.co.x + 1) / 2)
        left.add([vertex.index], 1 - weight, "REPLACE")
        right.add([vertex.index], weight, "REPLACE")
    body.parent = owner
    body.modifiers.new("Armature", "ARMATURE").object = owner
    instance = block()
    instance.materials.append(scales)
    for name, location, scale in [("Block", (2, 0, 0), (1, 1, 1)), ("Block mirrored", (-2, 0, 0), (-1, 1, 1))]:
        block_object = bpy.data.objects.new(name, instance)
        block_object.location, block_object.scale = location, scale
        link(block_object)
    bpy.context.view_layer.update()


def export(folder):
    def path(extension):
        return os.path.join(folder, "scene" + extension)

    bpy.ops.export_scene.fbx(filepath=path(".fbx"), add_leaf_bones=False, bake_anim=False, path_mode="RELATIVE")
    for extension, is_turned in [(".glb", True), (".z-up.glb", False)]:
        bpy.ops.export_scene.gltf(
            filepath=path(extension), export_yup=is_turned, export_animations=False, export_morph_normal=False
        )
    bpy.ops.wm.obj_export(filepath=path(".obj"), path_mode="RELATIVE")
    bpy.ops.wm.ply_export(filepath=path(".ply"), export_uv=True, export_normals=True)
    bpy.ops.wm.stl_export(filepath=path(".stl"))
    for extension in [".usda", ".usdc", ".usdz"]:
        bpy.ops.wm.usd_export(
            filepath=path(extension), export_shapekeys=True, export_armatures=True, export_textures_mode="KEEP"
        )


if __name__ == "__main__":
    build()
    export(sys.argv[1] if len(sys.argv) > 1 else HERE)
