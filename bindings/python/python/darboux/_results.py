"""What functions return. V vertices before, W after splitting; C corners."""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float32]
Numbers = npt.NDArray[np.uint32]


class Frames(NamedTuple):
    """The whole frame of every corner."""

    tangent: Floats
    """(C, 4): the direction of increasing u, unit length, and the sign w, -1 where the UV map mirrors."""
    bitangent: Floats
    """(C, 3): the direction of increasing v, unit length, perpendicular to the normal but not always to the tangent."""
    magnitude: Floats
    """(C, 2): world units per unit of u and per unit of v."""


class Report(NamedTuple):
    """What was met on the way. Quads count as the two triangles that they are split into."""

    triangles: int
    """Triangles, quad halves included."""
    unsupported_faces: int
    """Faces of other than 3 or 4 corners; they have tangents from their normals alone."""
    degenerate_triangles: int
    """Triangles with two equal positions."""
    uv_degenerate_triangles: int
    """Triangles, not degenerate, whose UVs span no area."""
    non_finite_corners: int
    """Corners with a NaN or an infinity in position, normal or UV."""
    repaired_corners: int
    """Corners whose reference tangent is absent or unusable. Replaced, but for mode='reference'."""
    mixed_sign_faces: int
    """Faces whose corners carry both signs; mode='corrected' gave them one."""
    mirrored_edges: int
    """Edges between two triangles of opposite UV orientation."""
    split_vertices: int
    """Vertices that need more than one tangent: what split_vertices splits."""
    merged_vertices: int
    """Vertices at which both UV orientations share one tangent: seams that method='lengyel-per-vertex' breaks."""


class VertexSplit(NamedTuple):
    """An indexed mesh's vertices after splitting. The old ones come first, in their old places."""

    tangent_of_vertex: Floats
    """(W, 4): unit xyz and sign w; (1, 0, 0, 1) for vertices that no corner uses."""
    indices: Numbers
    """The new vertex of each corner, in the shape of the old indices."""
    source_of_vertex: Numbers
    """(W,): the old vertex that each new one copies."""


class NormalSplit(NamedTuple):
    """An indexed mesh's vertices after splitting by normals. The old ones come first, in their old places."""

    normal_of_vertex: Floats
    """(W, 3): unit normals; (0, 0, 1) for vertices that no corner uses."""
    indices: Numbers
    """The new vertex of each corner, in the shape of the old indices."""
    source_of_vertex: Numbers
    """(W,): the old vertex that each new one copies."""
