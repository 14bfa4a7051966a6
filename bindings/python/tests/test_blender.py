"""The adapter to Blender, where it is installed as a module, and an outside check: its calc_tangents beside ours.

Blender has a MikkTSpace of its own, which takes another arc cosine, so that bits differ (test_blender_model.py). Directions may not, nor signs.
"""

from typing import Any, Callable, Dict

import darboux
import numpy as np
import pytest
from conftest import bits

bpy = pytest.importorskip("bpy", reason="Blender, or a library that it needs, is not installed as a module", exc_type=ImportError)

import darboux.bpy  # noqa: E402

LARGEST = 0.002
"""Degrees."""


def column(items: Any, name: str, width: int) -> np.ndarray:
    values = np.empty(len(items) * width, np.float32)
    items.foreach_get(name, values)
    return values.reshape(-1, width)


MAKERS: Dict[str, Callable[[], Any]] = {
    "sphere": lambda: bpy.ops.mesh.primitive_uv_sphere_add(calc_uvs=True),
    "monkey": lambda: bpy.ops.mesh.primitive_monkey_add(calc_uvs=True),
    "cylinder": lambda: bpy.ops.mesh.primitive_cylinder_add(calc_uvs=True, end_fill_type="TRIFAN"),
    "cube": lambda: bpy.ops.mesh.primitive_cube_add(calc_uvs=True),
    "torus": lambda: bpy.ops.mesh.primitive_torus_add(generate_uvs=True),
    "grid": lambda: bpy.ops.mesh.primitive_grid_add(calc_uvs=True),
}


@pytest.mark.parametrize("smooth", [True, False])
@pytest.mark.parametrize("name", MAKERS)
def test_blender_agrees(name: str, smooth: bool) -> None:
    MAKERS[name]()
    mesh = bpy.context.object.data
    mesh.polygons.foreach_set("use_smooth", [smooth] * len(mesh.polygons))
    mesh.update()
    darboux.bpy.add_tangents(mesh)
    attributes = mesh.attributes
    ours = np.hstack(
        [
            column(attributes["tangent"].data, "vector", 3),
            column(attributes["tangent_sign"].data, "value", 1),
        ]
    )
    mesh.calc_tangents(uvmap=mesh.uv_layers.active.name)
    theirs = np.hstack(
        [column(mesh.loops, "tangent", 3), column(mesh.loops, "bitangent_sign", 1)]
    )
    difference = darboux.measure_tangents(theirs, ours)
    assert difference.corners == len(mesh.loops) > 20
    assert (difference.sign_flips, difference.without_angle) == (0, 0)
    assert difference.max < LARGEST


def polygons(cut: bool) -> Any:
    """A quad, a hexagon and a concave octagon over a slope; cut: the last two as the triangles that Blender sees in them."""
    points = [(0, 0), (1, 0), (1, 1), (0, 1), (2, 0), (3, 1), (2, 2), (1, 2), (0, 3), (0.5, 2), (0, 2), (-1, 1)]
    faces = [(0, 1, 2, 3), (1, 4, 5, 6, 7, 2), (3, 2, 7, 8, 9, 10, 11)]
    mesh = bpy.data.meshes.new("polygons")
    mesh.from_pydata([(x, y, x * y / 8) for x, y in points], [], faces)
    if cut:
        mesh.calc_loop_triangles()
        triangles = [tuple(triangle.vertices) for triangle in mesh.loop_triangles if triangle.polygon_index > 0]
        mesh = bpy.data.meshes.new("triangles")
        mesh.from_pydata([(x, y, x * y / 8) for x, y in points], [], faces[:1] + triangles)
    uvs = [points[loop.vertex_index] for loop in mesh.loops]
    mesh.uv_layers.new(name="UVMap").uv.foreach_set("vector", np.array(uvs, np.float32).ravel())
    mesh.attributes.new("custom_normal", "FLOAT_VECTOR", "CORNER").data.foreach_set("vector", [0.0, 0.0, 1.0] * len(uvs))
    mesh.update()
    return mesh


def test_large_faces_are_cut_as_blender_cuts_them() -> None:
    """Blender's own calc_tangents refuses them."""
    whole, cut = polygons(False), polygons(True)
    found, of_triangles = (darboux.bpy.corner_tangents(mesh) for mesh in (whole, cut))
    assert (found.cut_faces, found.ambiguous_corners, of_triangles.cut_faces) == (2, 0, 0)
    tangent_of_vertex = {loop.vertex_index: bits(of_triangles.tangents[loop.index]) for loop in cut.loops}
    assert all(bits(found.tangents[loop.index]) == tangent_of_vertex[loop.vertex_index] for loop in whole.loops)


def test_uv_maps_are_chosen_by_name() -> None:
    mesh = polygons(False)
    turned = mesh.uv_layers.new(name="Turned")
    turned.uv.foreach_set("vector", column(mesh.uv_layers["UVMap"].uv, "vector", 2)[:, ::-1].ravel())
    assert not np.allclose(darboux.bpy.corner_tangents(mesh).tangents, darboux.bpy.corner_tangents(mesh, "Turned").tangents)
    with pytest.raises(ValueError, match="no UV map named 'Baked'; unwrap it first"):
        darboux.bpy.corner_tangents(mesh, "Baked")
    with pytest.raises(ValueError, match="has no UV map; unwrap it first"):
        darboux.bpy.add_tangents(bpy.data.meshes.new("empty"))
