import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "readers"))
from case import run
from panda3d.core import GlobPattern, LPoint2d, LPoint3d, LVector3d
from panda3d.egg import EggData, EggPolygon, EggVertex, EggVertexPool


def compute(case):
    if set(case["faces"]) - {3, 4}:
        raise ValueError("skip: triangles and quads only")
    if case["threshold"] != 180.0:
        raise ValueError("skip: no angular threshold")
    if any(x != x for key in ("positions", "normals", "uvs") for row in case[key] for x in row):
        return [(0.0,) * 4] * len(case["indices"])  # Panda3D stops at NaN with a failed assertion
    data, pool = EggData(), EggVertexPool("case")
    data.add_child(pool)
    corners, first = [], 0
    for size in case["faces"]:
        polygon = EggPolygon()
        data.add_child(polygon)
        for index in case["indices"][first : first + size]:
            vertex = EggVertex()
            vertex.set_pos(LPoint3d(*case["positions"][index]))
            vertex.set_normal(LVector3d(*case["normals"][index]))
            vertex.set_uv("", LPoint2d(*case["uvs"][index]))
            polygon.add_vertex(pool.add_vertex(vertex))
        corners += [(polygon, corner) for corner in range(size)]
        first += size
    start = time.process_time()
    data.recompute_tangent_binormal(GlobPattern(""))
    seconds = time.process_time() - start
    return {"tangents": [tangent(polygon.get_vertex(corner)) for polygon, corner in corners], "seconds": seconds}


def tangent(vertex):
    """Panda keeps a binormal instead of a sign."""
    uv = vertex.get_uv_obj("")
    if not uv or not uv.has_tangent():
        return (0.0,) * 4
    t, b, n = uv.get_tangent(), uv.get_binormal(), vertex.get_normal()
    return (t[0], t[1], t[2], -1.0 if n.cross(LVector3d(t[0], t[1], t[2])).dot(LVector3d(b[0], b[1], b[2])) < 0.0 else 1.0)


run(compute)
