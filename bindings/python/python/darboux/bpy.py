"""Tangents for Blender's meshes, inside Blender or with its module from PyPI.

Blender's UVs run up and its faces wind counter-clockwise, so that fresh tangents are in its convention as they are. Faces of five and more
corners, for which Mesh.calc_tangents fails, are cut into Blender's own triangles, as its exporters do.
"""

from typing import Any, Optional

import numpy as np
import numpy.typing as npt

import bpy

from . import _polygons
from ._polygons import PolygonTangents

ATTRIBUTE = "tangent"
"""The attribute of corners with the tangents' directions, float vectors."""
SIGN_ATTRIBUTE = "tangent_sign"
"""The attribute of corners with their signs, floats."""


def corner_tangents(mesh: "bpy.types.Mesh", uv_map: Optional[str] = None, **options: Any) -> PolygonTangents:
    """Compute the tangent of every corner, which Blender calls loop.

    Parameters
    ----------
    mesh : bpy.types.Mesh
        In object mode. Of an object with modifiers: `object.evaluated_get(depsgraph).to_mesh()`.
    uv_map : str, optional
        The name of a UV map; without, the active one.
    **options
        As for generate_tangents: method, mode, threshold, threads.

    Returns
    -------
    PolygonTangents
        `tangents`, (L, 4); `report`; the counts `cut_faces` and `ambiguous_corners`.

    Raises
    ------
    ValueError
        The mesh has no such UV map.
    """
    layers = mesh.uv_layers
    layer = layers.active if uv_map is None else layers.get(uv_map)
    if layer is None:
        wanted = "no UV map" if uv_map is None else f"no UV map named {uv_map!r}"
        raise ValueError(f"the mesh {mesh.name!r} has {wanted}; unwrap it first")
    vertices = _column(mesh.loops, "vertex_index", 1, np.int32).ravel()
    sizes = _column(mesh.polygons, "loop_total", 1, np.int32).ravel().astype(np.int64)
    triangles = np.empty((0, 3), np.int64)
    if (sizes > 4).any():
        mesh.calc_loop_triangles()
        triangles = _column(mesh.loop_triangles, "loops", 3, np.int32).astype(np.int64)
        face_of_triangle = _column(mesh.loop_triangles, "polygon_index", 1, np.int32).ravel()
        triangles = triangles[sizes[face_of_triangle] > 4]
    return _polygons.corner_tangents(
        _column(mesh.vertices, "co", 3)[vertices],
        _column(mesh.corner_normals, "vector", 3),
        _column(layer.uv, "vector", 2),
        sizes,
        triangles,
        **options,
    )


def add_tangents(mesh: "bpy.types.Mesh", uv_map: Optional[str] = None, **options: Any) -> PolygonTangents:
    """Put corner tangents into the mesh's attributes "tangent" and "tangent_sign", which geometry nodes, shaders and exporters can read.

    Parameters, results and errors are those of corner_tangents.
    """
    found = corner_tangents(mesh, uv_map, **options)
    _write_attribute(mesh, ATTRIBUTE, "FLOAT_VECTOR", "vector", found.tangents[:, :3])
    _write_attribute(mesh, SIGN_ATTRIBUTE, "FLOAT", "value", found.tangents[:, 3])
    return found


def _column(items: Any, name: str, width: int, dtype: Any = np.float32) -> npt.NDArray[Any]:
    """A property of all items as an array with a row for each."""
    values = np.empty(len(items) * width, dtype=dtype)
    items.foreach_get(name, values)
    return values.reshape(-1, width)


def _write_attribute(mesh: Any, name: str, kind: str, member: str, values: npt.NDArray[np.float32]) -> None:
    """Replaces a corner attribute."""
    if name in mesh.attributes:
        mesh.attributes.remove(mesh.attributes[name])
    mesh.attributes.new(name, kind, "CORNER").data.foreach_set(member, np.ascontiguousarray(values).ravel())
