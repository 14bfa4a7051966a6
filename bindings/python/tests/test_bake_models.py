"""Baking of models: files in, images out."""

import base64
import io
import json
import subprocess
import sys
from pathlib import Path
from typing import Any, Dict, List, Optional, Tuple

import darboux
import numpy as np
import pytest
from conftest import ROOT
from PIL import Image

PLATE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=np.float32)
NORMALS = np.array([[0, 0, 1]] * 4, dtype=np.float32)
UVS = np.array([[0, 1], [1, 1], [1, 0], [0, 0]], dtype=np.float32)
INDICES = np.array([0, 1, 2, 0, 2, 3], dtype=np.uint32)
ROOF = (PLATE + PLATE[:, :1] * [0, 0, 0.5]).astype(np.float32)
OPTIONS: Dict[str, Any] = {"size": (8, 4), "distance": (1, 1)}


def uri(data: bytes, kind: str = "application/octet-stream") -> str:
    return f"data:{kind};base64,{base64.b64encode(data).decode()}"


def part(positions: np.ndarray, name: str = "plate", material: Optional[int] = None, **leave_out: bool) -> Tuple[Any, ...]:
    arrays = {"POSITION": positions, "NORMAL": NORMALS, "TEXCOORD_0": UVS}
    return {name: array for name, array in arrays.items() if not leave_out.get(name)}, name, material


def model(*parts: Tuple[Any, ...], **members: Any) -> bytes:
    """A glTF of meshes of two triangles each."""
    blobs: List[bytes] = []
    gltf: Dict[str, Any] = {"asset": {"version": "2.0"}, "scene": 0, "accessors": [], "bufferViews": [], **members}

    def accessor(array: np.ndarray, component: int, kind: str) -> int:
        start = sum(map(len, blobs))
        blobs.append(np.ascontiguousarray(array).tobytes())
        view = {"buffer": 0, "byteOffset": start, "byteLength": len(blobs[-1])}
        gltf["bufferViews"].append(view)
        made = {"bufferView": len(gltf["accessors"]), "componentType": component, "count": len(array), "type": kind}
        bounds = {"min": array.min(0).tolist(), "max": array.max(0).tolist()} if kind == "VEC3" else {}
        gltf["accessors"].append({**made, **bounds})
        return len(gltf["accessors"]) - 1

    gltf["meshes"], gltf["nodes"] = [], []
    for arrays, name, material in parts:
        attributes = {semantic: accessor(array, 5126, f"VEC{array.shape[1]}") for semantic, array in arrays.items()}
        primitive = {"attributes": attributes, "indices": accessor(INDICES, 5125, "SCALAR")}
        primitive.update({} if material is None else {"material": material})
        gltf["nodes"].append({"mesh": len(gltf["meshes"]), "name": name})
        gltf["meshes"].append({"name": name, "primitives": [primitive]})
    gltf["scenes"] = [{"nodes": list(range(len(gltf["nodes"])))}]
    data = b"".join(blobs)
    gltf["buffers"] = [{"byteLength": len(data), "uri": uri(data)}]
    return json.dumps(gltf).encode()


def textured(positions: np.ndarray, left: Tuple[int, int, int], right: Tuple[int, int, int]) -> bytes:
    """A plate whose texture is of two colours."""
    image = Image.new("RGB", (16, 16), left)
    image.paste(right, (8, 0, 16, 16))
    png = io.BytesIO()
    image.save(png, "PNG")
    material = {
        "name": "paint",
        "pbrMetallicRoughness": {
            "baseColorTexture": {"index": 0}, "baseColorFactor": [0.5, 1, 1, 1], "roughnessFactor": 0.25, "metallicFactor": 0.75,
        },
        "emissiveFactor": [0, 0.5, 0],
    }  # fmt: skip
    images = [{"uri": uri(png.getvalue(), "image/png")}]
    return model(part(positions, material=0), materials=[material], textures=[{"source": 0}], images=images)


def test_models_give_the_bits_of_their_arrays(tmp_path: Path) -> None:
    tangents = darboux.generate_tangents(PLATE, NORMALS, UVS, INDICES)
    arrays = (PLATE, NORMALS, UVS, INDICES, tangents, ROOF, INDICES, NORMALS)
    chosen: Any = {"maps": ["normal", "height", "ao"], "samples": 2, "target": "directx"}
    low, high = model(part(PLATE)), model(part(ROOF))
    (tmp_path / "low.gltf").write_bytes(low)
    (tmp_path / "high.gltf").write_bytes(high)
    expected = darboux.bake(*arrays, **OPTIONS, **chosen)
    of_paths = darboux.bake_models(str(tmp_path / "low.gltf"), tmp_path / "high.gltf", **OPTIONS, **chosen)
    for baked in (darboux.bake_models(low, [high], **OPTIONS, **chosen), of_paths):
        for name in ("normal", "height", "ao", "states"):
            assert getattr(baked, name).tobytes() == getattr(expected, name).tobytes(), name
        assert baked.report == expected.report
        assert (baked.distance, baked.warnings, baked.legends) == ((1, 1), [], {})
    caged = darboux.bake_models(low, high, size=(8, 4), cage_offset=1)
    of_arrays = darboux.bake(*arrays, size=(8, 4), distance=(1, 1), cage=1)
    assert caged.normal is not None and of_arrays.normal is not None
    assert caged.normal.tobytes() == of_arrays.normal.tobytes()


def test_models_give_the_bits_of_the_command(tmp_path: Path) -> None:
    shield, out = ROOT / "assets/made/shield.glb", tmp_path / "normal.png"
    command = [sys.executable, "-m", "darboux", "bake", str(shield), "--high", str(shield), "-o", str(out), "--size", "64"]
    subprocess.run([*command, "--quiet"], check=True)
    baked = darboux.bake_models(shield, shield, size=(64, 64))
    assert baked.normal is not None
    codes = np.asarray(Image.open(out))[..., :3].astype(int)
    assert np.array_equal(codes, np.round(127.5 + 127.5 * baked.normal.astype(np.float64)))
    assert baked.distance[0] == baked.distance[1] > 0


def test_materials_and_textures_are_baked() -> None:
    maps: Any = ["base-color", "roughness", "metalness", "emission", "opacity", "id", "texture"]
    high = textured(PLATE, (188, 0, 255), (0, 255, 0))
    place = "pbrMetallicRoughness.baseColorTexture"
    baked = darboux.bake_models(model(part(PLATE)), high, maps=maps, texture=place, **OPTIONS)
    linear = ((188 / 255 + 0.055) / 1.055) ** 2.4
    assert baked.base_color is not None and baked.base_color.shape == (4, 8, 3)
    assert np.allclose(baked.base_color[:, :3], [linear / 2, 0, 1], atol=1e-5)
    assert np.allclose(baked.base_color[:, 5:], [0, 1, 0], atol=1e-5)
    assert baked.roughness is not None and np.allclose(baked.roughness, 0.25)
    assert baked.metalness is not None and np.allclose(baked.metalness, 0.75)
    assert baked.emission is not None and np.allclose(baked.emission, [0, 0.5, 0])
    assert baked.opacity is not None and np.allclose(baked.opacity, 1)
    assert baked.texture is not None and np.allclose(baked.texture[:, 5:], [0, 1, 0, 1], atol=1e-5)
    assert baked.id is not None and baked.normal is None
    [entry] = baked.legends["id"]
    assert (entry.name, entry.texels) == ("paint", 32)
    assert np.allclose(baked.id, np.array(entry.color) / 255)


def test_several_high_models_and_names() -> None:
    low = model(part(PLATE, "left_low"), part(PLATE + np.float32([2, 0, 0]), "right_low"))
    left, right = model(part(ROOF, "left_high")), model(part(PLATE + np.float32([2, 0, 0]), "right_high_top"))
    options: Any = {"size": (8, 4), "distance": (0.6, 0.6), "maps": ["id"], "id_from": "part"}
    only_left = darboux.bake_models(low, left, **options)
    both = darboux.bake_models(low, (left, right), **options)
    assert [entry.name for entry in both.legends["id"]] == ["left_high"]
    assert both.report.overlapping_texels == only_left.report.overlapping_texels == 32
    assert [darboux.bake_models(low, [right, left], **options).legends["id"][0].id] == [1]
    other = model(part(PLATE + np.float32([0, 0, 0.1]), "other_high"))
    near = darboux.bake_models(low, [left, other], **options)
    named = darboux.bake_models(low, [left, other], match="name", **options)
    assert [entry.name for entry in near.legends["id"]] == ["left_high", "other_high"]
    assert [entry.name for entry in named.legends["id"]] == ["left_high"] and near.warnings == []
    assert named.warnings == [
        "no part of the high models belongs to right_low; name it as the low part with _high in place of _low (or _hp of _lp), or do not match names",
        "no part of the low model belongs to other_high, which is left out",
    ]
    with pytest.raises(ValueError, match="no part of the high models belongs to left_low, right_low;"):
        darboux.bake_models(low, other, match="name", **options)


def test_the_size_and_the_cage_have_the_defaults_of_other_languages() -> None:
    baked = darboux.bake_models(model(part(PLATE)), model(part(PLATE)))
    assert baked.normal is not None and baked.normal.shape == (1024, 1024, 3)
    assert np.allclose(baked.distance, 0.02 * np.sqrt(2))


def test_a_cage_is_made_for_models() -> None:
    low, high = model(part(PLATE)), model(part(ROOF))
    tangents = darboux.generate_tangents(PLATE, NORMALS, UVS, INDICES)
    arrays = (PLATE, NORMALS, UVS, INDICES, tangents, ROOF, INDICES, NORMALS)
    cage = darboux.auto_cage(*arrays, reach=2)
    expected = darboux.bake(*arrays, size=(8, 4), cage=cage.positions, distance=(0, cage.inwards), maps=["height"])
    baked = darboux.bake_models(low, high, size=(8, 4), auto_cage=0.001, cage_offset=2, maps=["height"])
    assert baked.height is not None and expected.height is not None
    assert baked.height.tobytes() == expected.height.tobytes()
    assert (baked.distance, baked.report.missed_texels) == ((0, cage.inwards), 0)
    # The roof is higher than 10 % of the diagonal, but lower than the cage can be.
    assert darboux.bake_models(low, high, size=(8, 4), auto_cage=0.001).report.missed_texels > 0


def test_a_cage_can_be_a_model_and_rays_can_be_straight(tmp_path: Path) -> None:
    low, high = model(part(PLATE)), model(part(ROOF))
    cage = tmp_path / "cage.glb"
    cage.write_bytes(model(part(PLATE + np.float32([0, 0, 2]))))
    options: Any = {"size": (8, 4), "maps": ["height"]}
    inflated = darboux.bake_models(low, high, cage_offset=2, **options)
    for given in (cage, cage.read_bytes()):
        baked = darboux.bake_models(low, high, cage=given, cage_offset=2, **options)
        assert baked.height is not None and inflated.height is not None
        assert np.allclose(baked.height, inflated.height, atol=1e-6)
    with pytest.raises(ValueError, match="the cage has 2 primitives but the low model has 1; make the cage by moving"):
        darboux.bake_models(low, high, cage=model(part(PLATE), part(PLATE)), **options)
    with pytest.raises(ValueError, match="cage and auto_cage both say where rays begin"):
        darboux.bake_models(low, high, cage=cage, auto_cage=0.001, **options)
    for skew in (0.0, np.zeros((2, 2), np.uint8)):
        assert darboux.bake_models(low, high, cage_offset=2, skew=skew, **options).height is not None
    with pytest.raises(ValueError, match="a skew correction is 2; it must be from 0 to 1"):
        darboux.bake_models(low, high, skew=2.0, **options)


def test_bad_models_are_told_in_one_sentence(tmp_path: Path) -> None:
    plate, missing = model(part(PLATE)), tmp_path / "missing.glb"
    with pytest.raises(FileNotFoundError, match="missing.glb"):
        darboux.bake_models(missing, plate)
    with pytest.raises(FileNotFoundError, match="missing.glb"):
        darboux.bake_models(plate, [plate, missing])
    with pytest.raises(ValueError, match="^the low model: no triangles have UVs, onto which to bake; unwrap the model first$"):
        darboux.bake_models(model(part(PLATE, TEXCOORD_0=True)), plate)
    with pytest.raises(ValueError, match="has no normals, which the frames of a normal map need"):
        darboux.bake_models(model(part(PLATE, NORMAL=True)), plate)
    with pytest.raises(ValueError, match="no triangles have materials"):
        darboux.bake_models(plate, plate, material=99)
    with pytest.raises(ValueError, match="the high model"):
        darboux.bake_models(plate, b"not a model")
    with pytest.raises(ValueError, match="image of 0 x 4 texels cannot be made"):
        darboux.bake_models(missing, missing, size=(0, 4))
    with pytest.raises(ValueError, match="cage_offset and distance both say where rays begin"):
        darboux.bake_models(plate, plate, cage_offset=1, distance=(1, 1))
    with pytest.raises(ValueError, match="auto_cage and distance both say where rays begin"):
        darboux.bake_models(plate, plate, auto_cage=0.001, distance=(1, 1))
    with pytest.raises(ValueError, match="the share of rays that may change their hit is 2"):
        darboux.bake_models(missing, missing, auto_cage=2)
    with pytest.raises(ValueError, match="the map texture needs the option texture"):
        darboux.bake_models(missing, missing, maps=["texture"])
    with pytest.raises(ValueError, match="the option texture is for the map texture"):
        darboux.bake_models(missing, missing, texture="occlusionTexture")
    with pytest.raises(ValueError, match="match is 'near'; it must be one of 'nearest', 'name'"):
        darboux.bake_models(plate, plate, match="near")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="high is empty; give one model or several"):
        darboux.bake_models(plate, [])
    with pytest.raises(TypeError, match="low is <class 'int'>; give a path or the bytes of a file"):
        darboux.bake_models(3, plate)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="high is <class 'float'>; give a path or the bytes of a file"):
        darboux.bake_models(plate, [plate, 0.5])  # type: ignore[list-item]
    with pytest.raises(TypeError, match="progress must be callable"):
        darboux.bake_models(plate, plate, progress=3)  # type: ignore[arg-type]


def test_progress_is_told_and_its_errors_stop_the_bake() -> None:
    low, high = model(part(PLATE)), model(part(ROOF))
    told: List[Tuple[int, int]] = []
    darboux.bake_models(low, high, size=(256, 256), distance=(1, 1), progress=lambda *now: told.append(now))
    assert told[-1][0] == told[-1][1] > 1 and told == sorted(told)

    def stop(done: int, total: int) -> None:
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        darboux.bake_models(low, high, size=(256, 256), distance=(1, 1), progress=stop)


INTERRUPTED = """
import signal, sys, darboux
def interrupt(done, total):
    # Unlike os.kill, this returns once the signal is taken, however slow the machine.
    signal.raise_signal(signal.SIGINT)
try:
    darboux.bake_models(sys.argv[1], sys.argv[1], size=(1024, 1024), maps=["ao"], progress=interrupt)
except KeyboardInterrupt:
    print("interrupted")
"""


def test_ctrl_c_ends_a_bake() -> None:
    shield = str(ROOT / "assets/made/shield.glb")
    ran = subprocess.run([sys.executable, "-c", INTERRUPTED, shield], check=True, capture_output=True)
    assert ran.stdout.split() == [b"interrupted"]
