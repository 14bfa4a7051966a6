"""Blender's tangents and ours of the same arrays differ in the arc cosine alone: with Blender's, a slow model gives all bits of Blender's; with
the C library's, all of ours. assets/blender/calc_tangents.py wrote the arrays."""

from typing import Dict

import blender_model
import numpy as np
import pytest
from conftest import ROOT, bits

from darboux import _polygons


@pytest.fixture(scope="module")
def arrays() -> Dict[str, np.ndarray]:
    with np.load(ROOT / "assets/blender/calc_tangents.npz") as stored:
        return dict(stored)


@pytest.mark.parametrize("name, corners, same", [("monkey", 1968, 27), ("cylinder", 320, 168), ("cube", 24, 24)])
def test_only_the_arc_cosine_differs(arrays: Dict[str, np.ndarray], name: str, corners: int, same: int) -> None:
    positions, normals, uvs, sizes, theirs = (arrays[f"{name}_{kind}"] for kind in ("positions", "normals", "uvs", "sizes", "tangents"))
    found = _polygons.corner_tangents(positions, normals, uvs, sizes.astype(np.int64), np.empty((0, 3), np.int64))
    ours = np.ascontiguousarray(found.tangents, np.float32)
    model = [blender_model.corner_tangents(positions, normals, uvs, sizes, acos) for acos in (blender_model.polynomial_acos, blender_model.library_acos)]
    assert bits(model[0]) == bits(theirs)
    assert bits(model[1]) == bits(ours)
    assert (len(ours), int((ours == theirs).all(axis=1).sum())) == (corners, same)
