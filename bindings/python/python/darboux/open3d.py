"""Tangents for Open3D.

Open3D keeps UVs per corner, so tangents are kept per corner too, and no vertex is split. It turns v over when it reads glTF, so that it
runs up; tangents of such UVs are glTF's as they are.
"""

from typing import Any

import numpy as np
import numpy.typing as npt
import open3d

from ._darboux import generate_tangents

ATTRIBUTE = "tangents"
"""The key in a tensor mesh's triangle attributes."""


def corner_tangents(mesh: Any, **options: Any) -> npt.NDArray[np.float32]:
    """Compute the tangent of every corner of a mesh.

    Parameters
    ----------
    mesh : open3d.geometry.TriangleMesh or open3d.t.geometry.TriangleMesh
        With UVs. Normals are those of its vertices; without any, smooth ones are made first.
    **options
        As for generate_tangents: method, mode, threshold, threads.

    Returns
    -------
    (F, 3, 4) float32 array

    Raises
    ------
    ValueError
        The mesh has no UVs.
    """
    if isinstance(mesh, open3d.geometry.TriangleMesh):
        mesh = open3d.t.geometry.TriangleMesh.from_legacy(mesh)
    if "texture_uvs" not in mesh.triangle:
        raise ValueError("the mesh has no UVs, which Open3D calls texture_uvs or triangle_uvs; unwrap it first")
    if "normals" not in mesh.vertex:
        mesh = mesh.clone()
        mesh.compute_vertex_normals()
    corners = mesh.triangle.indices.numpy().ravel()
    positions, normals = (mesh.vertex[name].numpy()[corners] for name in ("positions", "normals"))
    uvs = mesh.triangle.texture_uvs.numpy().reshape(-1, 2)
    tangents: npt.NDArray[np.float32] = generate_tangents(positions, normals, uvs, **options)
    return tangents.reshape(-1, 3, 4)


def add_tangents(mesh: Any, **options: Any) -> None:
    """Put corner tangents into `mesh.triangle["tangents"]`, (F, 3, 4) float32.

    Parameters
    ----------
    mesh : open3d.t.geometry.TriangleMesh
        Changed in place. The older open3d.geometry.TriangleMesh has no place for tangents: use corner_tangents.
    **options
        As for generate_tangents.

    Raises
    ------
    TypeError, ValueError
        Another kind of mesh; no UVs.
    """
    if not isinstance(mesh, open3d.t.geometry.TriangleMesh):
        raise TypeError("the mesh must be an open3d.t.geometry.TriangleMesh; others have no place for tangents")
    mesh.triangle[ATTRIBUTE] = open3d.core.Tensor(corner_tangents(mesh, **options))
