"""Corner tangents of polygon meshes whose faces have any number of corners."""

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ._darboux import generate_tangents
from ._results import Floats, Report

Ints = npt.NDArray[np.int64]


class PolygonTangents(NamedTuple):
    """What corner_tangents returns."""

    tangents: Floats
    """(C, 4): unit xyz and sign w."""
    report: Report
    cut_faces: int
    """Faces of five and more corners, which MikkTSpace does not take; they were cut into triangles."""
    ambiguous_corners: int
    """Corners of cut faces whose triangles have different tangents. They have that of the first triangle."""


def fans(sizes: Ints) -> Ints:
    """(T, 3): the corners of triangles that cover the faces of five and more corners: a fan around each face's first corner."""
    first = np.cumsum(sizes) - sizes
    large = sizes > 4
    counts = sizes[large] - 2
    start = np.repeat(first[large], counts)
    step = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
    return np.stack([start, start + step + 1, start + step + 2], -1)


def corner_tangents(
    positions: npt.NDArray[Any], normals: npt.NDArray[Any], uvs: npt.NDArray[Any], sizes: Ints, triangles: Ints, **options: Any
) -> PolygonTangents:
    """Compute the tangent of every corner.

    positions, normals, uvs: one row per corner. sizes: the corners of each face. triangles: corners of the triangles that cover the faces
    of five and more corners, in any order.
    """
    face_of_corner = np.repeat(np.arange(len(sizes)), sizes)
    whole = np.flatnonzero(sizes[face_of_corner] <= 4)
    faces = np.concatenate([np.flatnonzero(sizes <= 4), face_of_corner[triangles[:, 0]]])
    face_sizes = np.concatenate([sizes[sizes <= 4], np.full(len(triangles), 3)])
    corners = np.concatenate([whole, triangles.ravel()])
    # The order of the faces stays: sums of rounded numbers depend on it.
    corners = corners[np.argsort(face_of_corner[corners], kind="stable")]
    face_sizes = face_sizes[np.argsort(faces, kind="stable")]
    found, report = generate_tangents(
        positions, normals, uvs, corners.astype(np.uint32), faces=face_sizes.astype(np.uint32), return_report=True, **options
    )
    tangents = np.zeros((len(face_of_corner), 4), np.float32)
    tangents[corners[::-1]] = found[::-1]
    different = (tangents[corners] != found).any(axis=1) & ~np.isnan(found).any(axis=1)
    return PolygonTangents(tangents, report, int((sizes > 4).sum()), len(np.unique(corners[different])))
