"""The adapter to Open3D, where it is installed."""

import darboux
import numpy as np
import pytest
from conftest import ROOT, bits, grid

open3d = pytest.importorskip("open3d", reason="Open3D, or a library that it needs, is not installed", exc_type=ImportError)

MODEL = ROOT / "assets/NormalTangentTest/NormalTangentTest.glb"


def test_tangents_of_a_file_that_open3d_reads() -> None:
    """Open3D turns v over as it reads glTF, so that its tangents have glTF's signs as they are."""
    import darboux.open3d

    mesh = open3d.t.io.read_triangle_mesh(str(MODEL))
    darboux.open3d.add_tangents(mesh)
    found = mesh.triangle[darboux.open3d.ATTRIBUTE].numpy()
    document = darboux.load(MODEL)
    document.add_tangents()
    arrays = document.arrays()
    difference = darboux.measure_tangents(arrays["TANGENT"][arrays["indices"]], found.reshape(-1, 4))
    assert (difference.corners, difference.sign_flips) == (3 * 7774, 0)
    # 1 - v went through other rounding.
    assert difference.max < 0.01


def test_both_kinds_of_meshes() -> None:
    import darboux.open3d

    mesh = grid(6, 6)
    uvs = mesh.uvs[mesh.indices.ravel()]
    legacy = open3d.geometry.TriangleMesh(
        open3d.utility.Vector3dVector(mesh.positions), open3d.utility.Vector3iVector(mesh.indices.astype(np.int32))
    )
    legacy.vertex_normals = open3d.utility.Vector3dVector(mesh.normals)
    with pytest.raises(ValueError, match="the mesh has no UVs"):
        darboux.open3d.corner_tangents(legacy)
    legacy.triangle_uvs = open3d.utility.Vector2dVector(uvs)
    expected = bits(darboux.generate_tangents(*mesh.arrays))
    assert bits(darboux.open3d.corner_tangents(legacy)) == expected
    with pytest.raises(TypeError, match="others have no place for tangents"):
        darboux.open3d.add_tangents(legacy)
    tensor = open3d.t.geometry.TriangleMesh.from_legacy(legacy)
    assert bits(darboux.open3d.corner_tangents(tensor, threads=1)) == expected
    del tensor.vertex["normals"]
    assert darboux.open3d.corner_tangents(tensor, method="area").shape == (72, 3, 4)
    assert "normals" not in tensor.vertex
