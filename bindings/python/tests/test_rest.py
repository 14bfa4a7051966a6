"""Normals, measures, conventions, encodings and plans."""

import darboux
import numpy as np
import pytest
from conftest import Mesh, bits, grid

FLAT = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
QUAD = np.array([[0, 1, 2, 3]])


def test_normals_and_their_split() -> None:
    cube = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    normals, report = darboux.generate_normals(cube, faces, crease=30, return_report=True)
    assert report == (6, 0, 0, 12)
    assert np.array_equal(np.abs(normals).sum(axis=1), np.ones(24))
    assert np.array_equal(normals, darboux.generate_normals(cube, faces, shading="flat"))
    split = darboux.split_normals(faces, normals, 8)
    assert split.indices.shape == (6, 4)
    assert len(split.source_of_vertex) == 24
    assert np.array_equal(split.normal_of_vertex[split.indices.ravel()], normals)
    smooth = darboux.generate_normals(cube, faces)
    assert np.allclose(smooth, (cube[np.ravel(faces)] * 2 - 1) / np.sqrt(3), atol=1e-6)


def test_bad_normals() -> None:
    with pytest.raises(ValueError, match="shading is 'round'; it must be one of 'smooth', 'flat'"):
        darboux.generate_normals(FLAT, QUAD, shading="round")  # type: ignore[call-overload]
    with pytest.raises(ValueError, match="crease is inf"):
        darboux.generate_normals(FLAT, QUAD, crease=float("inf"))
    with pytest.raises(ValueError, match="index 3 at place 3 is out of range"):
        darboux.generate_normals(FLAT[:3], QUAD)
    with pytest.raises(ValueError, match="11 normals were passed but the mesh has 12 corners"):
        darboux.split_normals([0] * 12, np.zeros((11, 3)), 1)


def test_measures(sheet: Mesh) -> None:
    tangents = darboux.generate_tangents(*sheet.arrays)
    same = darboux.measure_tangents(tangents, tangents)
    assert (same.corners, same.identical, same.max, same.worst) == (len(tangents), len(tangents), 0, [])
    turned = tangents.copy()
    turned[5] = [*np.cross(sheet.normals[sheet.indices.ravel()[5]], tangents[5, :3]), -tangents[5, 3]]
    other = darboux.measure_tangents(tangents, turned)
    assert (other.identical, other.sign_flips) == (len(tangents) - 1, 1)
    assert other.worst[0][0] == 5
    assert other.max == pytest.approx(90, abs=1e-3)
    assert other.histogram.sum() == len(tangents)
    fidelity = darboux.measure_uv_fidelity(FLAT, FLAT[:, :2], QUAD, [[1, 0, 0, 1]] * 4)
    assert fidelity == (0, 0, 1, 0)
    with pytest.raises(ValueError, match="5 tangents were passed but the mesh has 4 corners"):
        darboux.measure_uv_fidelity(FLAT, FLAT[:, :2], QUAD, np.zeros((5, 4)))


def test_conventions_may_have_changes() -> None:
    texels = np.arange(24, dtype=np.uint8).reshape(2, 3, 4)
    inverted = darboux.convert_texels(texels, "gltf", "gltf,green=down")
    assert np.array_equal(inverted[..., 1], 255 - texels[..., 1])
    assert np.array_equal(inverted[..., [0, 2, 3]], texels[..., [0, 2, 3]])
    wide = texels[..., :2].astype(np.uint16)
    both = darboux.convert_texels(wide, "gltf", "directx,red=left")
    assert both.dtype == np.uint16 and np.array_equal(both, 65535 - wide)
    turned = darboux.convert("gltf", "gltf,axes=-x/z/-y", positions=[[1, 2, 3]])
    assert turned.positions is not None and turned.positions.tolist() == [[1, -3, 2]]
    assert darboux.convert("gltf", "gltf,axes=-x/y/z").inverts_green is False
    with pytest.raises(ValueError, match='source: "metal" is not a convention; begin with one of gltf, '):
        darboux.convert("metal", "gltf")
    with pytest.raises(ValueError, match='target: green cannot be "left"; write up or down'):
        darboux.convert("gltf", "gltf,green=left")
    with pytest.raises(ValueError, match=r"texels must have shape \(H, W, 2 to 4\), not \(4, 4\)"):
        darboux.convert_texels(np.zeros((4, 4), np.uint8), "gltf", "directx")
    with pytest.raises(TypeError, match="texels must hold uint8 or uint16, not float64"):
        darboux.convert_texels(np.zeros((4, 4, 3)), "gltf", "directx")


def test_frames_under_matrices() -> None:
    half = np.sqrt(0.5)
    stretch = np.diag([2, 1, 1, 1])
    moved = darboux.transform_frames(stretch, [[half, half, 0]], [[half, -half, 0, 1]])
    assert np.allclose(moved.normals, np.array([[1, 2, 0]]) / np.sqrt(5), atol=1e-7)
    assert np.allclose(moved.tangents, [[2 / np.sqrt(5), -1 / np.sqrt(5), 0, 1]], atol=1e-7)
    assert moved.orientation == 1
    mirror = darboux.transform_frames(np.diag([-1, 1, 1]), [[0, 0, 1]], [[1, 0, 0, 1]])
    assert mirror.tangents.tolist() == [[-1, 0, 0, -1]] and mirror.orientation == -1
    turn = [[0, -1, 0, 7], [1, 0, 0, 8], [0, 0, 1, 9]]
    assert darboux.transform_frames(turn, [[0, 0, 1]], [[1, 0, 0, 1]]).tangents.tolist() == [[0, 1, 0, 1]]
    with pytest.raises(ValueError, match=r"matrix must have shape \(3, 3\), \(3, 4\) or \(4, 4\), not \(4, 3\)"):
        darboux.transform_frames(np.zeros((4, 3)), [[0, 0, 1]], [[1, 0, 0, 1]])
    with pytest.raises(ValueError, match="tangents has 2 elements but there are 1 normals"):
        darboux.transform_frames(stretch, [[0, 0, 1]], [[1, 0, 0, 1]] * 2)
    with pytest.raises(TypeError, match="matrix must hold real numbers, not complex128"):
        darboux.transform_frames(stretch * 1j, [[0, 0, 1]], [[1, 0, 0, 1]])


def test_frames_under_skins() -> None:
    turn = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]])
    bones = np.stack([np.eye(3), turn])
    normals, tangents = [[0, 0, 1]] * 3, [[1, 0, 0, -1]] * 3
    joints, weights = [[0, 1], [1, 0], [0, 1]], [[1, 0], [1, 0], [0.5, 0.5]]
    skinned = darboux.skin_frames(bones, joints, weights, normals, tangents)
    assert skinned[0].tolist() == normals
    half = np.sqrt(0.5)
    assert np.allclose(skinned[1], [[1, 0, 0, -1], [0, 1, 0, -1], [half, half, 0, -1]], atol=1e-7)
    for vertex in range(3):
        matrix = np.tensordot(weights[vertex], bones[joints[vertex]], 1)
        one = darboux.transform_frames(matrix, normals[:1], tangents[:1])
        assert np.array_equal(bits(one.tangents[0]), bits(skinned[1][vertex]))
    with pytest.raises(ValueError, match="joint 2 of vertex 1 is out of range: there are 2 bones"):
        darboux.skin_frames(bones, [[0, 1], [1, 2], [0, 1]], weights, normals, tangents)
    with pytest.raises(ValueError, match=r"weights has shape \(3, 1\) beside 3 normals and joints of shape \(3, 2\)"):
        darboux.skin_frames(bones, joints, [[1]] * 3, normals, tangents)
    with pytest.raises(ValueError, match=r"bones must have shape \(B, 3, 3\), .*, not \(3, 3\)"):
        darboux.skin_frames(turn, joints, weights, normals, tangents)


def test_conventions_come_back(sheet: Mesh) -> None:
    tangents = darboux.generate_tangents(*sheet.arrays)
    split = darboux.split_vertices(sheet.indices, tangents, len(sheet.positions))
    for source in darboux.CONVENTIONS:
        for target in darboux.CONVENTIONS:
            there = darboux.convert(
                source, target, positions=sheet.positions, indices=sheet.indices, tangents=split.tangent_of_vertex
            )
            assert there.uvs is None
            back = darboux.convert(
                target, source, positions=there.positions, indices=there.indices, tangents=there.tangents
            )
            assert bits(back.positions + 0) == bits(sheet.positions + 0)
            assert np.array_equal(back.indices, sheet.indices)
            assert np.array_equal(back.tangents, split.tangent_of_vertex)


def test_generated_tangents_become_those_of_programs() -> None:
    """v of glTF runs down: w, which follows v, is negated. Unity's space is the left hand's and its green points up."""
    generated = np.array([[1, 0, 0, 1]])
    assert darboux.convert("gltf", "gltf", tangents=generated, generated=True).tangents.tolist() == [[1, 0, 0, -1]]
    assert darboux.convert("opengl", "gltf", tangents=generated, generated=True).tangents.tolist() == [[1, 0, 0, 1]]
    found = darboux.convert("gltf", "directx", normals=[[0, 0, 1]], uvs=[[0.25, 0.25]], indices=[[0, 1, 2]])
    assert found.inverts_green and not found.inverts_red
    assert found.indices.tolist() == [[0, 2, 1]]


def test_bad_conversions() -> None:
    with pytest.raises(ValueError, match='source: "maya2" is not a convention; begin with one of gltf, opengl, '):
        darboux.convert("maya2", "gltf")
    with pytest.raises(ValueError, match="4 corners do not make whole faces"):
        darboux.convert("gltf", "unity", indices=[0, 1, 2, 3])
    with pytest.raises(ValueError, match="faces leave 1 of 4 corners over"):
        darboux.convert("gltf", "unity", indices=[0, 1, 2, 3], faces=[3])


@pytest.mark.parametrize(
    ("name", "kind", "width", "degrees"),
    [("snorm8", "i1", 4, 0.40), ("snorm10", "u4", 0, 0.098), ("snorm16", "i2", 4, 0.0016), ("octahedral", "i2", 2, 0.0057)],
)
def test_encodings(name: str, kind: str, width: int, degrees: float, sheet: Mesh) -> None:
    tangents = darboux.generate_tangents(*sheet.arrays)
    codes = getattr(darboux.encode, f"tangent_to_{name}")(tangents)
    assert codes.dtype == kind
    assert codes.shape == ((len(tangents), width) if width else (len(tangents),))
    decoded = getattr(darboux.encode, f"tangent_from_{name}")(codes)
    assert darboux.measure_tangents(tangents, decoded).max <= degrees
    assert np.array_equal(np.sign(decoded[:, 3]), tangents[:, 3])


def test_encodings_with_normals(sheet: Mesh) -> None:
    tangents = darboux.generate_tangents(*sheet.arrays)
    normals = darboux.encode.normal_from_octahedral(darboux.encode.normal_to_octahedral(sheet.normals))
    assert np.abs(normals - sheet.normals).max() < 1e-4
    normals = normals[sheet.indices.ravel()]
    codes = darboux.encode.tangent_to_diamond(normals, tangents)
    assert codes.dtype == np.uint16
    assert darboux.measure_tangents(tangents, darboux.encode.tangent_from_diamond(normals, codes)).max < 0.02
    quaternions = darboux.encode.frame_to_quaternion(normals, tangents)
    found_normals, found_tangents = darboux.encode.frame_from_quaternion(quaternions)
    assert np.abs(found_normals - normals).max() < 1e-3
    assert darboux.measure_tangents(tangents, found_tangents).max < 0.02


def test_bad_codes() -> None:
    with pytest.raises(TypeError, match="codes must hold int8, not int64"):
        darboux.encode.tangent_from_snorm8(np.zeros((2, 4), np.int64))  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"codes must have shape \(C, 4\), not \(4,\)"):
        darboux.encode.tangent_from_snorm8(np.zeros(4, np.int8))
    with pytest.raises(ValueError, match=r"codes must have shape \(C,\), not \(2, 2\)"):
        darboux.encode.tangent_from_snorm10(np.zeros((2, 2), np.uint32))
    with pytest.raises(ValueError, match="tangents has 2 elements but there are 3 normals"):
        darboux.encode.tangent_to_diamond(np.eye(3), np.eye(4)[:2])


def test_plans() -> None:
    mesh = grid(6, 5)
    plan = darboux.Plan(*mesh.arrays)
    expected, report = darboux.generate_tangents(*mesh.arrays, return_report=True)
    assert bits(plan.base) == bits(expected)
    assert plan.report == report
    assert bits(plan.evaluate(mesh.positions, mesh.normals)) == bits(expected)
    moved = mesh.positions * [1, 2, 1]
    assert plan.count_regrouped(moved, mesh.normals) == 0
    assert bits(plan.evaluate(moved, mesh.normals)) == bits(darboux.generate_tangents(moved, *mesh.arrays[1:]))
    by_area = darboux.Plan(*mesh.arrays, method="area")
    assert bits(by_area.base) == bits(darboux.generate_tangents(*mesh.arrays, method="area"))
    # The plan holds what it needs.
    mesh.uvs[:] = 0
    mesh.indices[:] = 0
    assert bits(plan.evaluate(mesh.positions, mesh.normals)) == bits(expected)
    with pytest.raises(ValueError, match="uvs has 42 elements but there are 41 positions"):
        plan.evaluate(mesh.positions[1:], mesh.normals[1:])
