"""Tangents for trimesh.

trimesh flips v when it reads and when it writes glTF, so v points up in memory. For such UVs the sign of MikkTSpace is that of glTF: it is
not negated here.

>>> scene_or_mesh.export("model.glb", include_normals=True, tree_postprocessor=darboux.trimesh.name_tangents)  # doctest: +SKIP
"""

from typing import Any, Dict

import numpy as np
import trimesh

from ._darboux import generate_tangents, split_vertices
from ._results import VertexSplit

ATTRIBUTE = "TANGENT"
"""The key in a mesh's vertex_attributes."""


def add_tangents(mesh: trimesh.Trimesh, **options: Any) -> VertexSplit:
    """Put tangents into `mesh.vertex_attributes["TANGENT"]`, (V, 4) float32, splitting vertices where they must be.

    Vertex normals, UVs, colours and other vertex attributes follow.

    Parameters
    ----------
    mesh : trimesh.Trimesh
        With UVs in its visual; changed in place.
    **options
        As for generate_tangents: method, mode, threshold, threads.

    Returns
    -------
    VertexSplit
        Use its `source_of_vertex` for other arrays with one element per vertex.

    Raises
    ------
    ValueError
        The mesh has no UVs.
    """
    uvs = getattr(mesh.visual, "uv", None)
    if uvs is None or len(uvs) != len(mesh.vertices):
        raise ValueError("the mesh has no UVs, one per vertex, in its visual; unwrap it first")
    normals = np.array(mesh.vertex_normals)
    tangents = generate_tangents(mesh.vertices, normals, uvs[:, :2], mesh.faces, **options)
    split = split_vertices(mesh.faces, tangents, len(mesh.vertices))
    if len(split.source_of_vertex) > len(normals):
        mesh.update_vertices(split.source_of_vertex.astype(np.int64), inverse=np.arange(len(normals)))
        mesh.faces = split.indices
    # Other faces made trimesh forget them.
    mesh.vertex_normals = normals[split.source_of_vertex]
    mesh.vertex_attributes[ATTRIBUTE] = split.tangent_of_vertex
    return split


def name_tangents(tree: Dict[str, Any]) -> None:
    """Give exported tangents glTF's own name: the `tree_postprocessor` of trimesh's glTF exports.

    trimesh writes all vertex attributes under names that begin with an underscore, which readers ignore.
    """
    for mesh in tree.get("meshes", []):
        for primitive in mesh["primitives"]:
            attributes = primitive["attributes"]
            if f"_{ATTRIBUTE}" in attributes:
                attributes[ATTRIBUTE] = attributes.pop(f"_{ATTRIBUTE}")
