"""Bad input: a ValueError or TypeError of one sentence, never anything else."""

import inspect
import random
import re
import struct
import subprocess
import sys
import zlib
from pathlib import Path
from typing import Any, Dict

import darboux
import numpy as np
import pytest
from conftest import ROOT, Mesh, grid

NAN = float("nan")


class Unreadable:
    """Looks like an array from afar."""

    def __array__(self, *_: Any, **__: Any) -> np.ndarray:
        raise RuntimeError("burnt\nto the ground")


def call(sheet: Mesh, changes: Dict[str, Any]) -> Any:
    arguments: Dict[str, Any] = dict(zip(("positions", "normals", "uvs", "indices"), sheet.arrays))
    arguments.update(changes)
    return darboux.generate_tangents(**arguments)


BAD = [
    ({"positions": np.zeros((88, 2))}, ValueError, r"positions must have shape \(V, 3\), not \(88, 2\)"),
    ({"positions": np.zeros(88)}, ValueError, r"positions must have shape \(V, 3\), not \(88,\)"),
    ({"positions": np.float32(1)}, ValueError, r"positions must have shape \(V, 3\), not \(\)"),
    ({"positions": np.zeros((88, 3), complex)}, TypeError, "positions must hold real numbers, not complex128"),
    ({"positions": np.zeros((88, 3), bool)}, TypeError, "positions must hold real numbers, not bool"),
    ({"positions": np.zeros((88, 3), object)}, TypeError, "positions must hold real numbers, not object"),
    ({"positions": None}, ValueError, r"positions must have shape \(V, 3\), not \(\)"),
    ({"positions": Unreadable()}, ValueError, "positions cannot be made an array: burnt$"),
    ({"positions": "mesh"}, ValueError, "positions must have shape"),
    ({"normals": np.zeros((87, 3))}, ValueError, "normals has 87 elements but there are 88 positions"),
    ({"uvs": np.zeros((88, 3))}, ValueError, r"uvs must have shape \(V, 2\), not \(88, 3\)"),
    ({"uvs": np.zeros((89, 2))}, ValueError, "uvs has 89 elements but there are 88 positions"),
    ({"indices": np.zeros(6)}, TypeError, "indices must hold integers, not float64"),
    ({"indices": np.zeros(6, bool)}, TypeError, "indices must hold integers, not bool"),
    ({"indices": np.array([0, 1, 88])}, ValueError, "index 88 at place 2 is out of range: there are 88 vertices"),
    ({"indices": np.array([0, -1, 2])}, ValueError, "indices holds -1 at place 1"),
    ({"indices": np.array([0, 1, 1 << 32])}, ValueError, "indices holds 4294967296 at place 2"),
    ({"indices": np.array([0, 1, (1 << 64) - 1], "u8")}, ValueError, "indices holds 18446744073709551615 at place 2"),
    ({"indices": np.zeros((2, 5), int)}, ValueError, r"indices must have shape \(C,\), \(F, 3\) or \(F, 4\), not \(2, 5\)"),
    ({"indices": np.zeros((2, 3, 3), int)}, ValueError, "indices must have shape"),
    ({"indices": np.zeros(7, int)}, ValueError, "7 corners do not make whole faces of 3"),
    ({"indices": np.zeros(7, int), "faces": 4}, ValueError, "7 corners do not make whole faces of 4"),
    ({"indices": [["a", "b", "c"]]}, TypeError, "indices must hold integers"),
    ({"faces": [3, 3]}, ValueError, "the face sizes add up to 6 but there are 420 corners"),
    ({"faces": [-3]}, ValueError, "faces holds -3 at place 0"),
    ({"faces": [3.0]}, TypeError, "faces must hold integers, not float64"),
    ({"faces": 5}, ValueError, "faces must be 3, 4 or one corner count per face"),
    ({"faces": "quads"}, ValueError, "faces must be 3, 4 or one corner count per face"),
    ({"faces": [1 << 31, 1 << 31]}, ValueError, "the face sizes add up to 4294967296"),
    ({"method": "mikk"}, ValueError, "method is 'mikk'; it must be one of 'mikktspace', "),
    ({"method": 3}, TypeError, ""),
    ({"mode": "exact"}, ValueError, "mode is 'exact'; it must be one of 'repaired', 'reference', 'corrected'"),
    ({"threshold": NAN}, ValueError, "threshold is NaN; it must be a number of degrees"),
    ({"threshold": "90"}, TypeError, ""),
    ({"threshold": 90, "method": "face"}, ValueError, "threshold belongs to method='mikktspace'"),
    ({"mode": "reference", "method": "face"}, ValueError, "mode belongs to method='mikktspace'"),
    ({"threads": 0}, ValueError, "threads is 0; it must be from 1 to 1024"),
    ({"threads": -1}, ValueError, "threads is -1"),
    ({"threads": 10**9}, ValueError, "threads is 1000000000"),
    ({"threads": 1 << 70}, ValueError, "threads is 1180591620717411303424; it must be from 1 to 1024"),
    ({"threads": 1.5}, TypeError, "threads must be a whole number, not float"),
    ({"threshold": 10**400}, ValueError, "threshold is inf; it must be a number of degrees"),
    ({"out": np.zeros((420, 3), "f4")}, ValueError, r"out must have shape \(420, 4\), not \(420, 3\)"),
    ({"out": np.zeros((420, 4))}, TypeError, "out must hold float32, not float64"),
    ({"out": [[0.0] * 4] * 420}, TypeError, "out must be a numpy array, not list"),
    ({"out": np.broadcast_to(np.zeros(4, "f4"), (420, 4))}, ValueError, "out is read-only"),
    ({"out": np.zeros((420, 4), "f4"), "full": True}, ValueError, "leave out either full or out"),
]


@pytest.mark.parametrize(("changes", "kind", "sentence"), BAD)
def test_bad_arguments(changes: Dict[str, Any], kind: Any, sentence: str, sheet: Mesh) -> None:
    with pytest.raises(kind) as caught:
        call(sheet, changes)
    assert re.search(sentence, str(caught.value)), str(caught.value)
    assert "\n" not in str(caught.value)


def test_bad_splits() -> None:
    mesh = grid(2, 2)
    tangents = darboux.generate_tangents(*mesh.arrays)
    with pytest.raises(ValueError, match="23 tangents were passed but the mesh has 24 corners; pass one per corner"):
        darboux.split_vertices(mesh.indices, tangents[:-1], 9)
    with pytest.raises(ValueError, match="index 8 at place 20 is out of range"):
        darboux.split_vertices(mesh.indices, tangents, 8)
    for count in (-1, 1 << 40, -(1 << 70)):
        with pytest.raises(ValueError, match=f"vertex_count is {count}; it must be from 0 to 4294967295"):
            darboux.split_vertices(mesh.indices, tangents, count)
        with pytest.raises(ValueError, match=f"vertex_count is {count}"):
            darboux.split_normals(mesh.indices, tangents[:, :3], count)
    with pytest.raises(ValueError, match="vertex_count is 268435456, more than 64 times the 24 corners"):
        darboux.split_vertices(mesh.indices, tangents, 2**28)
    with pytest.raises(TypeError, match="vertex_count must be a whole number, not str"):
        darboux.split_vertices(mesh.indices, tangents, "9")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"tangents must have shape \(C, 4\)"):
        darboux.split_vertices(mesh.indices, tangents[:, :3], 9)


ODD_VALUES = [
    None, True, 0, -1, 1 << 70, 1.5, NAN, "x", b"x", [], [[]], [[[]]], [1, 2, 3], [[1, 2, 3]], [[0.5, NAN, 1e300]],
    {}, set(), object(), np.float32(1), np.zeros((0, 3)), np.zeros((3, 0)), np.zeros((3, 3), "datetime64[s]"),
    np.zeros((3, 3), "U3"), np.zeros(3, [("a", "f4")]), np.full((3, 3), np.nan), np.full((3, 3), 255, "u1"),
    np.lib.stride_tricks.as_strided(np.zeros(1, "f4"), (3, 3), (0, 0)), np.ma.masked_all((3, 3)),
]  # fmt: skip


def test_a_sweep_of_odd_values() -> None:
    """Whatever stands wherever, a call returns or raises one of these errors."""
    triangle = np.eye(3, dtype=np.float32)
    base: Dict[str, Any] = {"positions": triangle, "normals": triangle, "uvs": triangle[:, :2], "indices": [0, 1, 2]}
    returned = 0
    for name in (*base, "faces", "method", "mode", "threshold", "full", "threads", "out", "return_report"):
        for value in ODD_VALUES:
            for other in ("positions", "indices", "faces"):
                arguments = {**base, other: value, name: value}
                try:
                    darboux.generate_tangents(**arguments)
                    returned += 1
                except (ValueError, TypeError) as error:
                    assert "\n" not in str(error), error
    assert returned > 10


DAMAGED = ["made/degenerate.gltf", "made/draco.glb", "made/meshopt.glb", "made/quantised-sparse.glb"]


@pytest.mark.parametrize("model", DAMAGED)
def test_damaged_files(model: str) -> None:
    """Bytes replaced, cut out and doubled: an error of one sentence, or tangents."""
    dice, whole = random.Random(2), (ROOT / "assets" / model).read_bytes()
    refused = 0
    for _ in range(200):
        data = bytearray(whole)
        for _ in range(dice.choice([1, 1, 2, 20])):
            at = dice.randrange(len(data))
            end = at + dice.choice([1, 1, 1, 4, 50])
            data[at:end] = dice.choice([bytes([dice.randrange(256)]), b"", b"-1", data[at:end] * 2, b"\xff" * 4])
        try:
            document = darboux.loads(bytes(data))
            document.add_tangents(overwrite=True)
            document.inspect()
            darboux.loads(darboux.dumps(document))
        except ValueError as error:
            refused += 1
            assert "\n" not in str(error), error
    assert 20 < refused < 200


TRIANGLE = np.eye(3, dtype=np.float32)
GOOD_VALUES = [
    TRIANGLE, TRIANGLE[:, :2], np.eye(4, dtype="f4")[:3], [0, 1, 2], [[0, 1, 2]], 3, [3], "gltf", "unity", True, "repaired", "smooth",
    np.zeros((3, 4), "i2"), np.zeros((3, 2), "i2"), np.zeros((3, 4), "i1"), np.zeros(3, "u2"), np.zeros(3, "u4"),
]  # fmt: skip


def test_random_arguments_everywhere() -> None:
    """Every function, with arguments that fit and arguments that do not."""
    dice = random.Random(1)
    functions = [getattr(darboux, name) for name in darboux.__all__ if name.islower() and name[0] != "_"]
    functions = [function for function in functions if callable(function) and function.__name__ not in ("batch", "process", "save")]
    functions += [darboux.Plan] + [getattr(darboux.encode, name) for name in darboux.encode.__all__]
    assert len(functions) > 20
    returned = set()
    for _ in range(20_000):
        function = dice.choice(functions)
        arguments = {}
        for name, parameter in inspect.signature(function).parameters.items():
            if parameter.default is inspect.Parameter.empty or dice.random() < 0.2:
                arguments[name] = dice.choice(ODD_VALUES if dice.random() < 0.1 else GOOD_VALUES)
        try:
            function(**arguments)
            returned.add(function.__name__)
        except (ValueError, TypeError, OSError) as error:
            assert "\n" not in str(error), (function, arguments)
    assert len(returned) > len(functions) / 2, returned


@pytest.mark.skipif(sys.platform != "linux", reason="limits of addresses are Linux's")
def test_limits_of_the_process_count(tmp_path: Path) -> None:
    """An image that decodes to more than the process may use is named, and does not end the process."""
    rows = b"".join(b"\0" + b"\x80\x80\xff" * 5000 for _ in range(5000))

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = chunk(b"IHDR", struct.pack(">IIBBBBB", 5000, 5000, 8, 2, 0, 0, 0))
    png = b"\x89PNG\r\n\x1a\n" + header + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")
    path = tmp_path / "map.png"
    path.write_bytes(png)
    assert "5000 x 5000 texels" not in str(darboux.check(path))
    program = """
import resource, sys, darboux
used = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (used + (100 << 20),) * 2)
print(darboux.check(sys.argv[1]))
"""
    run = subprocess.run([sys.executable, "-c", program, str(path)], capture_output=True, text=True, check=False)
    assert run.returncode == 0 and "5000 x 5000 texels" in run.stdout, run.stderr + run.stdout
