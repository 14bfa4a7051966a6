import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "readers"))
import assimp_py
from case import run
from gltf import check, tangents_per_corner, write_glb

FILE = Path(tempfile.mkdtemp()) / "case.glb"


def compute(case):
    check(case)
    write_glb(FILE, case)
    scene = assimp_py.import_file(str(FILE), assimp_py.Process_CalcTangentSpace)
    corners = []
    for mesh in scene.meshes:
        size = mesh.num_vertices
        positions, normals, tangents, bitangents = (rows(values, 3, size) for values in (mesh.vertices, mesh.normals, mesh.tangents, mesh.bitangents))
        # assimp flips v of glTF files when it reads them.
        uvs = [(u, 1.0 - v) for u, v, *_ in rows(mesh.texcoords[0], len(memory(mesh.texcoords[0])) // size, size)]
        signed = [(*t, 1.0 if sign(n, t, b) >= 0.0 else -1.0) if t is not None else None for n, t, b in zip(normals, tangents, bitangents)]
        corners += [(positions[i], normals[i], uvs[i], signed[i]) for i in memory(mesh.indices)]
    # With v flipped by the reader the bitangent is MikkTSpace's negated, as in glTF; tangents_per_corner negates it back.
    return tangents_per_corner(case, corners)


def memory(values):
    view = memoryview(values)
    return view.cast("B").cast(view.format).tolist() if view.ndim > 1 else view.tolist()


def rows(values, width, count):
    if values is None:
        return [None] * count
    flat = memory(values)
    return [tuple(flat[width * i : width * i + width]) for i in range(count)]


def sign(n, t, b):
    return sum((n[(i + 1) % 3] * t[(i + 2) % 3] - n[(i + 2) % 3] * t[(i + 1) % 3]) * b[i] for i in range(3))


run(compute)
