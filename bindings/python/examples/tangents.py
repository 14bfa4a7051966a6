"""Tangents of a strip of two quads whose texture is mirrored at x = 0, one per corner: those of one vertex may differ."""

import darboux
import numpy as np

positions = np.array([[-1, 0, 0], [0, 0, 0], [1, 0, 0], [-1, 1, 0], [0, 1, 0], [1, 1, 0]])
normals = np.array([[0, 0, 1]] * 6)
uvs = np.array([[1, 0], [0, 0], [1, 0], [1, 1], [0, 1], [1, 1]])
quads = np.array([[0, 1, 4, 3], [1, 2, 5, 4]])
tangents = darboux.generate_tangents(positions, normals, uvs, quads)
for vertex, (x, y, z, w) in zip(quads.ravel(), tangents):
    print(f"vertex {vertex}: {x:g} {y:g} {z:g} {w:g}")
