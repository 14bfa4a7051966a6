import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "readers"))
from case import run
from pyray import ffi
from raylib import rl


def compute(case):
    if set(case["faces"]) - {3}:
        raise ValueError("skip: triangles only")
    if case["threshold"] != 180.0:
        raise ValueError("skip: no angular threshold")
    if len(case["positions"]) > 65535:
        raise ValueError("skip: indices have 16 bits")
    flat = lambda key: ffi.new("float[]", [x for row in case[key] for x in row])
    arrays = [flat("positions"), flat("normals"), flat("uvs"), ffi.new("unsigned short[]", case["indices"])]
    mesh = ffi.new("Mesh *", {"vertexCount": len(case["positions"]), "triangleCount": len(case["faces"])})
    mesh.vertices, mesh.normals, mesh.texcoords, mesh.indices = arrays
    start = time.process_time()
    rl.GenMeshTangents(mesh)
    seconds = time.process_time() - start
    if mesh.tangents == ffi.NULL:
        return {"tangents": [(0.0,) * 4] * len(case["positions"]), "indices": case["indices"]}
    found = [tuple(mesh.tangents[4 * v : 4 * v + 4]) for v in range(len(case["positions"]))]
    rl.MemFree(mesh.tangents)
    return {"tangents": found, "indices": case["indices"], "seconds": seconds}


run(compute)
