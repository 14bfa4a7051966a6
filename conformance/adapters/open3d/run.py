import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "readers"))
import numpy as np
import open3d as o3d
from case import run


def compute(case):
    if set(case["faces"]) - {3}:
        raise ValueError("skip: triangles only")
    if case["threshold"] != 180.0:
        raise ValueError("skip: no angular threshold")
    if not case["faces"]:
        raise ValueError("skip: no meshes without triangles")
    mesh = o3d.t.geometry.TriangleMesh()
    indices = np.array(case["indices"], dtype=np.int64).reshape(-1, 3)
    mesh.vertex.positions = o3d.core.Tensor(np.array(case["positions"], dtype=np.float32))
    mesh.vertex.normals = o3d.core.Tensor(np.array(case["normals"], dtype=np.float32))
    mesh.triangle.indices = o3d.core.Tensor(indices)
    mesh.triangle.texture_uvs = o3d.core.Tensor(np.array(case["uvs"], dtype=np.float32)[indices])
    start = time.process_time()
    try:
        mesh.compute_tangent_space(bake=False)
    except RuntimeError as error:
        print(case["name"], error, file=sys.stderr)
        return [(float("nan"),) * 4] * len(case["indices"])
    seconds = time.process_time() - start
    # Open3D may have made more vertices; its triangles keep their order.
    return {"tangents": mesh.vertex.tangents.numpy(), "indices": mesh.triangle.indices.numpy().ravel(), "seconds": seconds}


run(compute)
