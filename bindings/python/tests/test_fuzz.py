"""Arrays of every kind that numpy has, at random: they mean what a plain copy of them means, or are refused in one sentence."""

import random
from typing import Any, Callable, Dict, List, Tuple, Union

import darboux
import numpy as np
import pytest

Arrays = Dict[str, Any]

Outcome = Union[Tuple[bytes, ...], type]
"""The bits of what was returned, or the class of the error."""

DTYPES = ["f4", "f4", "f4", ">f4", "f8", ">f8", "f2", "longdouble", "i1", "i8", ">i2", "u1", "u8", "?", "c8", "O", "U2", "M8[s]", "V4"]
INTEGERS = ["u4", "u4", "u2", ">u4", ">i2", "i1", "u1", "i4", "i8", "u8", "f4", "?", "O", "U2"]


def odd_floats(dice: random.Random, shape: Tuple[int, ...]) -> np.ndarray:
    palette = [0.0, -0.0, 1.0, -1.0, 0.5, 3.0, 1e-40, 1e30, 1e300, float("nan"), float("inf")]
    few = palette[: dice.choice([4, 6, len(palette)])]
    return np.array([dice.choice(few) for _ in range(int(np.prod(shape)))]).reshape(shape)


def laid_out(dice: random.Random, values: np.ndarray) -> np.ndarray:
    """An equal array that lies in memory in some other way."""
    columns = values.shape[-1] if values.ndim == 2 else 1
    layouts: List[Callable[[], np.ndarray]] = [
        lambda: values,
        lambda: np.asfortranarray(values),
        lambda: values[::-1].copy()[::-1],
        lambda: values[..., ::-1].copy()[..., ::-1],
        lambda: np.repeat(values, 3, axis=0)[::3],
        lambda: np.concatenate([values, values], axis=-1)[..., : values.shape[-1]],
        lambda: np.broadcast_to(values, (2, *values.shape))[1],
        lambda: values.T.copy().T,
        lambda: misaligned(values),
        lambda: np.ma.array(values),
        lambda: values.reshape(-1, 1, columns).squeeze(1) if values.ndim == 2 else values,
    ]
    made = dice.choice(layouts)()
    if dice.random() < 0.2:
        made = made.view()
        made.flags.writeable = False
    return made


def misaligned(values: np.ndarray) -> np.ndarray:
    if values.dtype.hasobject or values.size == 0:
        return values
    memory = np.zeros(values.nbytes + 1, np.uint8)
    made = memory[1:].view(values.dtype).reshape(values.shape)
    made[...] = values
    return made


def rows(dice: random.Random, count: int, columns: int) -> np.ndarray:
    count = max(0, count + dice.choice([0] * 20 + [-1, 1]))
    shape: Tuple[int, ...] = (count, max(0, columns + dice.choice([0] * 20 + [-1, 1])))
    shape = dice.choice([shape] * 20 + [(count * columns,), (1, *shape), (*shape, 1)])
    with np.errstate(all="ignore"):
        try:
            values = odd_floats(dice, shape).astype(dice.choice(DTYPES * 3 + ["f4"] * 60))
        except (OverflowError, TypeError, ValueError):
            values = np.zeros(shape, "f4")
    return laid_out(dice, values)


def indices(dice: random.Random, vertices: int) -> np.ndarray:
    columns = dice.choice([3, 3, 3, 4, 4, 2, 5])
    shape = dice.choice([(dice.randrange(5), columns)] * 3 + [(dice.randrange(13),), (0,), (0, 3), (2, 3, 1)])
    far = [vertices, -1, 1 << 16, (1 << 31) - 1, 1 << 32, (1 << 63) - 1, (1 << 64) - 1]
    numbers = [dice.randrange(max(1, vertices)) for _ in range(int(np.prod(shape)))]
    if numbers and dice.random() < 0.1:
        numbers[dice.randrange(len(numbers))] = dice.choice(far)
    dtype = dice.choice(INTEGERS)
    with np.errstate(all="ignore"):
        try:
            values = np.array(numbers, dtype=dtype)
        except (OverflowError, TypeError, ValueError):
            values = np.array(numbers, dtype="O")
    return laid_out(dice, values.reshape(shape))


def plain(value: Any) -> Any:
    """A packed copy of native numbers, which only the simplest code has to read."""
    if not isinstance(value, np.ndarray) or value.dtype.kind not in "fiu":
        return value
    with np.errstate(all="ignore"):
        wide = np.float32 if value.dtype.kind == "f" else np.uint64 if value.dtype.kind == "u" else np.int64
        return np.array(np.asarray(value), dtype=wide, order="C")


def outcome(function: Callable[..., Any], arrays: Arrays) -> Outcome:
    try:
        made = function(**arrays)
    except (ValueError, TypeError, MemoryError) as error:
        assert "\n" not in str(error) and str(error), error
        return type(error)
    parts = made if isinstance(made, tuple) else (made,)
    return tuple(part.tobytes() if isinstance(part, np.ndarray) else repr(part).encode() for part in parts)


def calls(dice: random.Random) -> Tuple[Callable[..., Any], Arrays]:
    vertices = dice.choice([0, 1, 3, 4, 6, 9])
    mesh: Arrays = {"positions": rows(dice, vertices, 3), "normals": rows(dice, vertices, 3), "uvs": rows(dice, vertices, 2)}
    if dice.random() < 0.9:
        mesh["indices"] = indices(dice, vertices)
    if dice.random() < 0.2:
        mesh["faces"] = dice.choice([3, 4, 5, indices(dice, 5)])
    corners = len(mesh.get("indices", ())) * 3
    tangents = rows(dice, corners, 4)
    list_of_corners = indices(dice, vertices)
    choices: List[Tuple[Callable[..., Any], Arrays]] = [
        (darboux.generate_tangents, {**mesh, "full": dice.random() < 0.5}),
        (darboux.generate_tangents, {**mesh, "mode": "reference", "threshold": 30}),
        (darboux.generate_tangents, {**mesh, "method": "angle-area"}),
        (darboux.generate_normals, {name: mesh[name] for name in ("positions", "indices", "faces") if name in mesh}),
        (darboux.split_vertices, {"indices": list_of_corners, "tangents": tangents, "vertex_count": dice.choice([vertices, -1, 1 << 70])}),
        (darboux.measure_tangents, {"a": tangents, "b": rows(dice, corners, 4)}),
        (darboux.convert, {"source": "gltf", "target": "unity", **mesh}),
        (darboux.encode.tangent_to_diamond, {"normals": rows(dice, vertices, 3), "tangents": rows(dice, vertices, 4)}),
        (darboux.encode.frame_to_quaternion, {"normals": rows(dice, vertices, 3), "tangents": rows(dice, vertices, 4)}),
        (darboux.encode.tangent_to_snorm10, {"tangents": tangents}),
    ]
    return dice.choice(choices)


@pytest.mark.filterwarnings("ignore:invalid value:RuntimeWarning", "ignore:overflow:RuntimeWarning")
@pytest.mark.parametrize("seed", range(8))
def test_arrays_of_every_kind(seed: int) -> None:
    dice = random.Random(seed)
    returned = 0
    for step in range(1000):
        function, arrays = calls(dice)
        before = {name: np.array(value) for name, value in arrays.items()}
        found = outcome(function, arrays)
        expected = outcome(function, {name: plain(value) for name, value in arrays.items()})
        assert found == expected, (step, function, arrays)
        for name, value in arrays.items():
            assert np.asarray(value).tobytes() == before[name].tobytes(), (step, name)
        returned += isinstance(found, tuple)
    assert returned > 150


@pytest.mark.parametrize("seed", range(4))
def test_outputs_of_every_kind(seed: int) -> None:
    """What `out` is: written as a new array would be, or refused and left as it was."""
    dice = random.Random(seed)
    mesh = [np.eye(3, dtype="f4"), np.ones((3, 3), "f4"), np.eye(3, dtype="f4")[:, :2].copy()]
    expected = darboux.generate_tangents(*mesh)
    written = 0
    for _ in range(400):
        out = rows(dice, 3, 4)
        if not isinstance(out, np.ma.MaskedArray) and out.base is None and dice.random() < 0.5:
            out = out.copy()
        before = np.asarray(out).tobytes()
        try:
            assert darboux.generate_tangents(*mesh, out=out) is out
            assert np.array_equal(np.asarray(out, dtype="f4"), expected)
            written += 1
        except (ValueError, TypeError) as error:
            assert "\n" not in str(error)
            assert np.asarray(out).tobytes() == before
    assert written > 40
