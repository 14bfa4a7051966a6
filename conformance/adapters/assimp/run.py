import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "readers"))
import assimp_py
from case import run
from gltf import check, write_glb

FORMAT = sys.argv.pop(1)
FILE = Path(tempfile.mkdtemp()) / f"case.{FORMAT}"


def write_obj(path, case):
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in case["positions"]]
    lines += [f"vn {x!r} {y!r} {z!r}" for x, y, z in case["normals"]]
    lines += [f"vt {u!r} {v!r}" for u, v in case["uvs"]]
    corners = [f"{i + 1}/{i + 1}/{i + 1}" for i in case["indices"]]
    lines += ["f " + " ".join(corners[at : at + 3]) for at in range(0, len(corners), 3)]
    path.write_text("\n".join(lines) + "\n", encoding="ascii")


def compute(case):
    """Tangents of a file, whose v points up in OBJ and down in glTF. assimp keeps the order of its triangles."""
    check(case)
    {"obj": write_obj, "glb": write_glb}[FORMAT](FILE, case)
    try:
        scene = assimp_py.import_file(str(FILE), assimp_py.Process_CalcTangentSpace)
    except RuntimeError as error:
        print(case["name"], error, file=sys.stderr)
        return [(0.0,) * 4] * len(case["indices"])
    mesh = scene.meshes[0]
    indices = memoryview(mesh.indices).tolist()
    if mesh.tangents is None or len(indices) != len(case["indices"]):
        return [(0.0,) * 4] * len(case["indices"])
    normals, tangents, bitangents = (rows(values) for values in (mesh.normals, mesh.tangents, mesh.bitangents))
    # assimp's bitangent points down the image: against v in OBJ, along v in glTF.
    along = -1.0 if FORMAT == "obj" else 1.0
    signed = [(*t, 1.0 if along * handedness(n, t, b) > 0.0 else -1.0) for n, t, b in zip(normals, tangents, bitangents)]
    return [signed[i] for i in indices]


def rows(values):
    flat = memoryview(values).tolist()
    return [tuple(flat[at : at + 3]) for at in range(0, len(flat), 3)]


def handedness(n, t, b):
    return sum((n[(i + 1) % 3] * t[(i + 2) % 3] - n[(i + 2) % 3] * t[(i + 1) % 3]) * b[i] for i in range(3))


run(compute)
