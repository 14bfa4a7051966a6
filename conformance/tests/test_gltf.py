"""What readers/gltf.py finds in converted files: python3 -m unittest discover conformance/tests"""

import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "readers"))

from gltf import tangents_per_corner  # noqa: E402

# Two triangles with one edge, on whose sides the tangents are opposite. Rounded to four digits, 0.25005 is 0.2501 or 0.25 by its last bits.
BORDER = 0.25005
POSITIONS = [(BORDER, 0.0, 0.0), (1.0, BORDER, 0.0), (0.0, 1.0, 0.0), (1.0, 1.0, 0.0)]
INDICES = [0, 1, 2, 1, 3, 2]
CASE = {"positions": POSITIONS, "normals": [(0.0, 0.0, 1.0)] * 4, "uvs": [p[:2] for p in POSITIONS], "indices": INDICES}
LEFT, RIGHT = (1.0, 0.0, 0.0, 1.0), (-1.0, 0.0, 0.0, -1.0)
EXPECTED = [(*t[:3], -t[3]) for t in [LEFT] * 3 + [RIGHT] * 3]


def converted(error=0.0, order=(0, 1, 2, 3, 4, 5)):
    """The corners of a file that moved all positions by `error`."""
    corners = []
    for at in order:
        x, y, z = POSITIONS[INDICES[at]]
        corners.append(((x + error, y + error, z + error), (0.0, 0.0, 1.0), CASE["uvs"][INDICES[at]], LEFT if at < 3 else RIGHT))
    return corners


class Found(unittest.TestCase):
    def test_triangles_in_another_order(self):
        self.assertEqual(tangents_per_corner(CASE, converted(order=(4, 5, 3, 2, 0, 1))), EXPECTED)

    def test_errors_that_round_to_other_digits(self):
        for error in (1e-7, -1e-7, 4e-5, -4e-5):
            self.assertEqual(tangents_per_corner(CASE, converted(error)), EXPECTED, error)

    def test_other_vertices_are_not_found(self):
        self.assertEqual(tangents_per_corner(CASE, converted(1e-3)), [(0.0,) * 4] * 6)

    def test_a_corner_is_found_in_another_triangle(self):
        found = tangents_per_corner(CASE, converted()[:3])
        self.assertEqual(found, EXPECTED[:3] + [EXPECTED[1], (0.0,) * 4, EXPECTED[2]])


if __name__ == "__main__":
    unittest.main()
