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
