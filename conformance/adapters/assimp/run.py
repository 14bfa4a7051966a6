import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "readers"))
import assimp_py
from case import run
from gltf import check

FILE = Path(tempfile.mkdtemp()) / "case.obj"


def compute(case):
    """Tangents of an OBJ file, whose v points up. assimp keeps one vertex per corner, in the file's order."""
    check(case)
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in case["positions"]]
    lines += [f"vn {x!r} {y!r} {z!r}" for x, y, z in case["normals"]]
    lines += [f"vt {u!r} {v!r}" for u, v in case["uvs"]]
    corners = [f"{i + 1}/{i + 1}/{i + 1}" for i in case["indices"]]
    lines += ["f " + " ".join(corners[at : at + 3]) for at in range(0, len(corners), 3)]
    FILE.write_text("\n".join(lines) + "\n", encoding="ascii")
    scene = assimp_py.import_file(str(FILE), assimp_py.Process_CalcTangentSpace)
    mesh = scene.meshes[0]
    indices = memoryview(mesh.indices).tolist()
    if mesh.tangents is None or len(indices) != len(case["indices"]):
        return [(0.0,) * 4] * len(case["indices"])
    normals, tangents, bitangents = (rows(values) for values in (mesh.normals, mesh.tangents, mesh.bitangents))
    # assimp's bitangent points down the image, against v.
    signed = [(*t, 1.0 if handedness(n, t, b) < 0.0 else -1.0) for n, t, b in zip(normals, tangents, bitangents)]
    return [signed[i] for i in indices]


def rows(values):
    flat = memoryview(values).tolist()
    return [tuple(flat[at : at + 3]) for at in range(0, len(flat), 3)]


def handedness(n, t, b):
    return sum((n[(i + 1) % 3] * t[(i + 2) % 3] - n[(i + 2) % 3] * t[(i + 1) % 3]) * b[i] for i in range(3))


run(compute)
