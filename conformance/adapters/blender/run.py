import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "readers"))
import bpy
import case as reader
from gltf import check, read_glb, tangents_per_corner

FILE = Path(tempfile.mkdtemp()) / "case.glb"
METHOD = sys.argv.pop(1)
reader.REPETITIONS = 1


def compute(case):
    if METHOD == "file":
        check(case)
    if set(case["faces"]) - {3, 4}:
        raise ValueError("skip: triangles and quads only")
    if case["threshold"] != 180.0:
        raise ValueError("skip: no angular threshold")
    if not case["faces"]:
        raise ValueError("skip: no meshes without faces")
    faces, first = [], 0
    for size in case["faces"]:
        faces.append(case["indices"][first : first + size])
        first += size
    if any(len(set(face)) < len(face) for face in faces):
        raise ValueError("skip: Blender has no faces with a repeated vertex")
    mesh = build(case, faces)
    try:
        return exported(case) if METHOD == "file" else computed(mesh)
    finally:
        for data in (bpy.data.objects, bpy.data.meshes, bpy.data.materials, bpy.data.images):
            for block in list(data):
                data.remove(block)


def build(case, faces):
    """A mesh object with the case's vertices, normals and UVs per corner, in this order."""
    mesh = bpy.data.meshes.new("case")
    mesh.from_pydata(case["positions"], [], faces)
    if len(mesh.polygons) != len(faces) or [loop.vertex_index for loop in mesh.loops] != case["indices"]:
        raise ValueError("skip: Blender keeps other faces than the case has")
    layer = mesh.uv_layers.new(name="UVMap")
    layer.data.foreach_set("uv", [x for index in case["indices"] for x in case["uvs"][index]])
    # Free custom normals, as floats per vertex. normals_split_custom_set keeps 16 bits per corner, which differ from face to face.
    normals = mesh.attributes.new("custom_normal", "FLOAT_VECTOR", "POINT")
    normals.data.foreach_set("vector", [x for normal in case["normals"] for x in normal])
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("case", mesh))
    return mesh


def computed(mesh):
    mesh.calc_tangents(uvmap="UVMap")
    return [(*loop.tangent, loop.bitangent_sign) for loop in mesh.loops]


def exported(case):
    FILE.unlink(missing_ok=True)
    bpy.ops.export_scene.gltf(filepath=str(FILE), export_tangents=True, export_yup=False, export_materials="NONE", export_normals=True, export_texcoords=True)
    # The exporter flips v. Flipping it back finds the corners and negates the sign once more.
    corners = [(p, n, (u, 1.0 - v), t and (*t[:3], -t[3])) for p, n, (u, v), t in read_glb(FILE)] if FILE.exists() else []
    return tangents_per_corner(case, corners)


bpy.ops.wm.read_factory_settings(use_empty=True)
reader.run(compute)
