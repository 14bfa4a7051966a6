"""Tangent frames for normal mapping: MikkTSpace bit for bit, and the vertex splitting that its seams demand.

Arrays in, arrays out. Tangents come one per corner (a vertex of one face); split_vertices goes back to an indexed mesh:

>>> import darboux, numpy as np
>>> positions = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
>>> normals = np.array([[0, 0, 1]] * 4)
>>> uvs = positions[:, :2]
>>> indices = np.array([[0, 1, 2], [0, 2, 3]])
>>> tangents = darboux.generate_tangents(positions, normals, uvs, indices)
>>> split = darboux.split_vertices(indices, tangents, len(positions))
>>> split.tangent_of_vertex
array([[1., 0., 0., 1.],
       [1., 0., 0., 1.],
       [1., 0., 0., 1.],
       [1., 0., 0., 1.]], dtype=float32)
>>> positions = positions[split.source_of_vertex]
"""

from ._darboux import __version__, generate_tangents, split_normals, split_vertices
from ._results import Frames, NormalSplit, Report, VertexSplit

__all__ = [
    "Frames",
    "NormalSplit",
    "Report",
    "VertexSplit",
    "__version__",
    "generate_tangents",
    "split_normals",
    "split_vertices",
]
