"""A slow model of the MikkTSpace in Blender since 3.3, for meshes without degenerate triangles: what `Mesh.calc_tangents` computes, in its roundings.

It differs from mikktspace.c in one number: the corner angle, which weights a triangle's tangent. mikktspace.c takes the arc cosine of the C
library in double precision. Blender takes a polynomial in single precision, up to 4.5e-5 radians beside it. The model takes either, so that
the tests can show that nothing else differs.
"""

from typing import Callable, Dict, List, Tuple

import numpy as np

Angles = Callable[[np.ndarray], np.ndarray]

COEFFICIENTS = [np.float32(c) for c in (-0.02164095, 0.077980478, -0.213300989, 1.5707963267)]
"""Of acos(x) = sqrt(1 - x) * polynomial(x) for x in [0, 1], highest power first (https://www.pouet.net/topic.php?which=9132&page=2)."""


def polynomial_acos(cosine: np.ndarray) -> np.ndarray:
    """Blender's arc cosine."""
    x = np.abs(cosine)
    x = np.where(x < 1, np.float32(1) - (np.float32(1) - x), np.float32(1))
    polynomial = np.zeros_like(x)
    for coefficient in COEFFICIENTS:
        polynomial = coefficient + x * polynomial
    angle = np.sqrt(np.float32(1) - x) * polynomial
    return np.where(cosine < 0, np.float32(np.pi) - angle, angle)


def library_acos(cosine: np.ndarray) -> np.ndarray:
    """The arc cosine of mikktspace.c."""
    return np.arccos(cosine.astype(np.float64)).astype(np.float32)


def corner_tangents(positions: np.ndarray, normals: np.ndarray, uvs: np.ndarray, sizes: np.ndarray, acos: Angles) -> np.ndarray:
    """The tangents (L, 4) of the corners of triangles and quads.

    positions, normals, uvs: (L, 3), (L, 3), (L, 2), single precision. sizes: the number of corners of each face.
    """
    triangles, face_of_triangle = _triangles(positions, uvs, sizes)
    vertices = np.unique(np.hstack([positions, normals, uvs]) + np.float32(0), axis=0, return_inverse=True)[1].ravel()
    tangents, preserving = _face_tangents(positions, uvs, triangles)
    _one_orientation_per_quad(uvs, triangles, face_of_triangle, preserving)
    group = _groups(vertices[triangles], preserving)
    sums = np.zeros((group.max() + 1, 3), np.float32)
    for triangle, corners in enumerate(triangles):
        for place in range(3):
            at, after, before = (corners[(place + step) % 3] for step in (0, 1, 2))
            normal, origin = normals[at], positions[at]
            edges = (_projected(normal, positions[other] - origin) for other in (after, before))
            weight = acos(np.clip(_dot(*edges), np.float32(-1), np.float32(1)))
            sums[group[triangle, place]] += _projected(normal, tangents[triangle]) * weight
    return _corner_results(len(positions), triangles, group, _normalized(sums), preserving)


def _triangles(positions: np.ndarray, uvs: np.ndarray, sizes: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """Triangles as corners, quads cut along the shorter diagonal in UV space, and the face of each."""
    triangles: List[Tuple[int, int, int]] = []
    faces: List[int] = []
    starts = np.cumsum(sizes) - sizes
    for face, (first, size) in enumerate(zip(starts, sizes)):
        a, b, c, d = range(first, first + 4)
        if size == 3:
            triangles.append((a, b, c))
        else:
            lengths = [[_dot(v[i] - v[j], v[i] - v[j]) for i, j in ((c, a), (d, b))] for v in (uvs, positions)]
            ac, bd = lengths[0] if lengths[0][0] != lengths[0][1] else lengths[1]
            is_first = ac < bd if lengths[0][0] != lengths[0][1] else not bd < ac
            triangles += [(a, b, c), (a, c, d)] if is_first else [(a, b, d), (b, c, d)]
        faces += [face] * (size - 2)
    return np.array(triangles), np.array(faces)


def _face_tangents(positions: np.ndarray, uvs: np.ndarray, triangles: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """The direction of growing u on every triangle, and whether its UVs wind as its corners do."""
    p, t = positions[triangles], uvs[triangles]
    d1, d2 = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    t21, t31 = t[:, 1] - t[:, 0], t[:, 2] - t[:, 0]
    area = t21[:, 0] * t31[:, 1] - t21[:, 1] * t31[:, 0]
    along = t31[:, 1:] * d1 - t21[:, 1:] * d2
    sign = np.where(area > 0, np.float32(1), np.float32(-1))
    return along * (sign / np.sqrt(_dot(along, along)))[:, None], area > 0


def _one_orientation_per_quad(uvs: np.ndarray, triangles: np.ndarray, face: np.ndarray, preserving: np.ndarray) -> None:
    """Halves of a quad with both orientations take that of the larger half in UV space."""
    t = uvs[triangles]
    t21, t31 = t[:, 1] - t[:, 0], t[:, 2] - t[:, 0]
    area = np.abs(t21[:, 0] * t31[:, 1] - t21[:, 1] * t31[:, 0])
    for half in np.flatnonzero(face[1:] == face[:-1]):
        preserving[half : half + 2] = preserving[half if area[half] >= area[half + 1] else half + 1]


def _groups(vertices: np.ndarray, preserving: np.ndarray) -> np.ndarray:
    """The group of each triangle's corners: corners at a vertex that edges between triangles of the same orientation connect."""
    parent = list(range(vertices.size))

    def root(item: int) -> int:
        while parent[item] != item:
            item = parent[item]
        return item

    corner_of_edge: Dict[Tuple[int, int], int] = {}
    for triangle, corners in enumerate(vertices.tolist()):
        for place in range(3):
            after = (place + 1) % 3
            edge = (corners[place], corners[after])
            other = corner_of_edge.pop(edge[::-1], None)
            if other is None:
                corner_of_edge[edge] = 3 * triangle + place
            elif preserving[other // 3] == preserving[triangle]:
                other_after = 3 * (other // 3) + (other + 1) % 3
                parent[root(3 * triangle + place)] = root(other_after)
                parent[root(3 * triangle + after)] = root(other)
    roots = [root(item) for item in range(vertices.size)]
    return np.unique(roots, return_inverse=True)[1].reshape(-1, 3)


def _corner_results(
    corners: int, triangles: np.ndarray, group: np.ndarray, tangents: np.ndarray, preserving: np.ndarray
) -> np.ndarray:
    """The tangent of a corner is that of its group; a quad's corner in two groups has the mean of both."""
    out = np.zeros((corners, 4), np.float32)
    for triangle, places in enumerate(triangles):
        for corner, found in zip(places, tangents[group[triangle]]):
            if out[corner, 3] != 0 and (out[corner, :3] != found).any():
                found = _normalized(out[corner, :3] + found)
            out[corner, :3] = found
            out[corner, 3] = 1 if preserving[triangle] else -1
    return out


def _dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Products added from left to right."""
    products = a * b
    total = products[..., 0]
    for column in range(1, products.shape[-1]):
        total = total + products[..., column]
    return total


def _normalized(vectors: np.ndarray) -> np.ndarray:
    return vectors * (np.float32(1) / np.sqrt(_dot(vectors, vectors)))[..., None]


def _projected(normal: np.ndarray, vector: np.ndarray) -> np.ndarray:
    """The direction of a vector in the plane of a normal."""
    return _normalized(vector - normal * _dot(normal, vector))
