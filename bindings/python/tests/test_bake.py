"""Baking: arrays in, images out."""

from typing import Any, Dict

import darboux
import numpy as np
import pytest

PLATE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=np.float32)
NORMALS = np.array([[0, 0, 1]] * 4, dtype=np.float32)
UVS = np.array([[0, 1], [1, 1], [1, 0], [0, 0]], dtype=np.float32)
INDICES = np.array([[0, 1, 2], [0, 2, 3]])
ROOF = PLATE + PLATE[:, :1] * [0, 0, 0.5]
OPTIONS: Dict[str, Any] = {"size": (8, 4), "distance": (1, 1)}


def baked(**options: Any) -> darboux.BakedMaps:
    tangents = darboux.generate_tangents(PLATE, NORMALS, UVS, INDICES)
    return darboux.bake(PLATE, NORMALS, UVS, INDICES, tangents, ROOF, INDICES, **{**OPTIONS, **options})


def test_every_map_of_a_roof() -> None:
    maps = baked(maps=["normal", "object-normal", "height", "ao", "position"])
    leaning = np.array([-1, 0, 2]) / np.sqrt(5)
    x = (np.arange(8) + 0.5) / 8
    assert maps.normal is not None and maps.normal.shape == (4, 8, 3)
    assert np.allclose(maps.normal, leaning, atol=1e-6)
    assert maps.object_normal is not None and np.allclose(maps.object_normal, leaning, atol=1e-6)
    assert maps.height is not None and np.allclose(maps.height, x / 2, atol=1e-6)
    assert maps.ao is not None and np.allclose(maps.ao, 1)
    assert maps.position is not None and np.allclose(maps.position[..., 0], x, atol=1e-6)
    assert (maps.states == 1).all()
    assert (maps.report.charted_texels, maps.report.rays, maps.report.missed_texels) == (32, 32, 0)


def test_only_chosen_maps_are_made() -> None:
    maps = baked()
    assert maps.normal is not None
    assert (maps.object_normal, maps.height, maps.ao, maps.position) == (None, None, None, None)


def test_options_act() -> None:
    tilted = PLATE + PLATE[:, 1:2] * [0, 0, 0.5]
    tangents = darboux.generate_tangents(PLATE, NORMALS, UVS, INDICES)

    def green(target: str) -> float:
        maps = darboux.bake(PLATE, NORMALS, UVS, INDICES, tangents, tilted, INDICES, target=target, **OPTIONS)
        assert maps.normal is not None
        return float(maps.normal[0, 0, 1])

    assert green("gltf") == -green("directx") != 0
    missed = baked(distance=(0.25, 0))
    assert missed.report.missed_texels == (missed.states == 3).sum() == 16
    caged = baked(distance=(0.25, 0), cage=1.0)
    assert caged.report.missed_texels == 0
    moved = baked(distance=(0.25, 0), cage=PLATE + [0, 0, 1])
    assert np.array_equal(moved.states, caged.states)
    one, many = baked(size=(100, 100), threads=1), baked(size=(100, 100), threads=3)
    assert one.normal is not None and many.normal is not None and one.normal.tobytes() == many.normal.tobytes()
    inside_out = darboux.bake(PLATE, NORMALS, UVS, INDICES, tangents, ROOF, INDICES[:, ::-1], **OPTIONS)
    assert (inside_out.states == 4).all()
    both = darboux.bake(PLATE, NORMALS, UVS, INDICES, tangents, ROOF, INDICES[:, ::-1], back_faces=True, **OPTIONS)
    assert (both.states == 1).all()
    smooth = darboux.bake(PLATE, NORMALS, UVS, INDICES, tangents, ROOF, INDICES, NORMALS, **OPTIONS)
    assert smooth.normal is not None and np.allclose(smooth.normal, [0, 0, 1], atol=1e-6)


def test_bad_arguments() -> None:
    with pytest.raises(ValueError, match="maps is 'bump'; it must be one of 'normal'"):
        baked(maps=["bump"])
    with pytest.raises(ValueError, match="image of 0 x 4 texels cannot be made"):
        baked(size=(0, 4))
    with pytest.raises(ValueError, match="give two finite distances"):
        baked(distance=(-1, 1))
    with pytest.raises(ValueError, match="17 samples per axis cannot be taken"):
        baked(samples=17)
    with pytest.raises(ValueError, match="the cage has 3 vertices but the low surface has 4"):
        baked(cage=PLATE[:3])
    with pytest.raises(ValueError, match="target: .maple. is not a convention"):
        baked(target="maple")
    with pytest.raises(ValueError, match="high_indices must be triangles"):
        tangents = darboux.generate_tangents(PLATE, NORMALS, UVS, INDICES)
        darboux.bake(PLATE, NORMALS, UVS, INDICES, tangents, ROOF, [[0, 1, 2, 3]], **OPTIONS)
    with pytest.raises(ValueError, match="5 tangents were passed but the mesh has 6 corners"):
        darboux.bake(PLATE, NORMALS, UVS, INDICES, tangents[:5], ROOF, INDICES, **OPTIONS)


def plate_and_roof() -> Any:
    tangents = darboux.generate_tangents(PLATE, NORMALS, UVS, INDICES)
    return PLATE, NORMALS, UVS, INDICES, tangents, ROOF, INDICES


def test_the_error_of_a_map_in_degrees() -> None:
    meshes = plate_and_roof()
    options: Any = {"distance": (1, 1)}
    maps = darboux.bake(*meshes, size=(64, 32), **options)
    assert maps.normal is not None
    exact = darboux.verify(*meshes, baked=maps, **options)
    assert exact.all.points == 64 * 32 and exact.all.worst < 1e-3 and exact.rounding.worst == 0
    assert exact.heat.shape == (32, 64) and exact.points_without_hit == 0
    codes = np.round(127.5 + 127.5 * maps.normal).astype(np.uint8)
    written = darboux.verify(*meshes, baked=maps, written=codes, **options)
    assert 0 < written.all.median < 0.4 and written.all == written.rounding
    fine = darboux.verify(*meshes, baked=maps, written=codes.astype(np.uint16) * 257, **options)
    assert fine.all.points == written.all.points and fine.all.median < 0.4
    # Green is zero on this roof; turned, it stays.
    assert written.other_green.median < 0.8
    one, many = (darboux.verify(*meshes, baked=maps, written=codes, threads=n, **options) for n in (1, 3))
    assert one.all == many.all and one.heat.tobytes() == many.heat.tobytes()
    with pytest.raises(ValueError, match="baked has no normal map"):
        darboux.verify(*meshes, baked=baked(maps=["height"]), **options)
    with pytest.raises(ValueError, match="written must have shape \\(H, W, 3\\), not \\(4, 3\\)"):
        darboux.verify(*meshes, baked=maps, written=PLATE, **options)


def test_maps_go_from_space_to_space() -> None:
    low = plate_and_roof()[:5]
    maps = baked(size=(16, 16), maps=["normal", "object-normal"])
    assert maps.normal is not None and maps.object_normal is not None
    tangent = darboux.convert_space(*low, maps.object_normal, to="tangent")
    assert np.allclose(tangent.texels, maps.normal, atol=1e-6)
    assert (tangent.charted_texels, tangent.overlapping_texels, tangent.invalid_texels) == (256, 0, 0)
    assert np.allclose(darboux.convert_space(*low, tangent.texels, to="object").texels, maps.object_normal, atol=1e-6)
    green = darboux.convert_space(*low, maps.object_normal, to="tangent", target="directx").texels
    assert np.allclose(green * [1, -1, 1], maps.normal, atol=1e-6)
    with pytest.raises(ValueError, match="to is 'world'; it must be one of 'tangent', 'object'"):
        darboux.convert_space(*low, maps.object_normal, to="world")  # type: ignore[arg-type]


def test_a_cage_is_made_and_used() -> None:
    meshes = plate_and_roof()
    cage = darboux.auto_cage(*meshes, reach=2)
    assert cage.positions.shape == (4, 3) and 0.5 < cage.least <= cage.most < 0.6 and cage.inwards < 0.1
    maps = darboux.bake(*meshes, size=(8, 8), cage=cage.positions, distance=(0, cage.inwards))
    assert maps.report.missed_texels == 0
    with pytest.raises(ValueError, match="the largest offset of a cage is 0"):
        darboux.auto_cage(*meshes, reach=0)


def test_skew_and_tiles() -> None:
    amounts: Any = [0.0, np.zeros(2, np.float32), np.zeros((4, 4), np.uint8)]
    plain = baked(maps=["position"])
    for skew in amounts:
        same = baked(maps=["position"], skew=skew)
        assert same.position is not None and plain.position is not None
        assert same.position.tobytes() == plain.position.tobytes()
    with pytest.raises(ValueError, match="a skew correction is 2"):
        baked(skew=2)
    with pytest.raises(TypeError, match="skew must be a number"):
        baked(skew="much")
    moved = UVS + [3, -1]
    assert darboux.udim_tiles(PLATE, NORMALS, moved.astype(np.float32), INDICES) == [1014]
    tangents = darboux.generate_tangents(PLATE, NORMALS, moved, INDICES)
    tile = darboux.bake(PLATE, NORMALS, moved, INDICES, tangents, ROOF, INDICES, udim=1014, **OPTIONS)
    assert tile.report.charted_texels == 32
    with pytest.raises(ValueError, match="udim is 12; it must be a number of a tile"):
        baked(udim=12)
