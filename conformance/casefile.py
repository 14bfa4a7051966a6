"""Reads and writes case files. FORMAT.md describes them."""

import ctypes
import json
import math
import struct
from pathlib import Path

CASES = Path(__file__).parent / "cases"
CLASSES = ("core", "seams", "quads", "thresholds", "degenerate", "hostile", "large")
INPUTS = ("positions", "normals", "uvs")
OUTPUTS = ("tangents", "bitangents", "magnitudes")
MODES = ("repaired", "corrected")


def f32(x):
    """Rounds to single precision."""
    return ctypes.c_float(x).value


def text(x):
    """The shortest decimal that reads back to the same single-precision number; a quoted word for NaN and infinities."""
    if not math.isfinite(x):
        return '"nan"' if x != x else '"inf"' if x > 0 else '"-inf"'
    for digits in range(1, 18):
        short = float(f"{x:.{digits}g}")
        if f32(short) == x:
            return repr(short)
    raise ValueError(f"{x!r} is not a single-precision number")


def word(x):
    """The bits as eight hexadecimal digits. Every NaN is 7fc00000."""
    return "7fc00000" if x != x else struct.pack(">f", x).hex()


def words(rows):
    """The bits of rows of numbers, little-endian."""
    return b"".join(bytes.fromhex(word(x))[::-1] for row in rows for x in row)


def read(path):
    """One case as a dictionary whose numbers are rounded to single precision. The bits must agree with the decimals."""
    case = json.loads(Path(path).read_text(encoding="utf-8"))
    case["threshold"] = f32(float(case["threshold"]))
    expected = case.get("expected", {})
    expected = expected.get("sample", expected)
    rows = {key: case for key in INPUTS} | {key: expected for key in (*OUTPUTS, *MODES)}
    for key, owner in rows.items():
        if key in owner:
            owner[key] = [[f32(float(x)) for x in row] for row in owner[key]]
            bits = case.get("bits", {}).get(key)
            if bits is not None and bits != [[word(x) for x in row] for row in owner[key]]:
                raise ValueError(f"{path}: the bits of {key} are not those of the decimals")
    return case


def read_all(folder=CASES):
    """All cases of a folder, sorted by name. Large ones without vertices are left out."""
    cases = [read(path) for path in sorted(Path(folder).glob("*.json"))]
    return [case for case in cases if "positions" in case]


def rows_text(rows, item):
    if not rows:
        return "[]"
    return "[\n" + ",\n".join("   [" + ", ".join(map(item, row)) + "]" for row in rows) + "\n  ]"


def quoted(x):
    return f'"{word(x)}"'


def write(path, case):
    """Writes a case in its canonical form: one row of numbers per line."""
    members = [(key, json.dumps(case[key], ensure_ascii=False)) for key in ("name", "class", "stage", "shows", "failure")]
    members.append(("threshold", text(case["threshold"])))
    members += [(key, json.dumps(case[key])) for key in ("generator", "corners") if key in case]
    if "positions" in case:
        members += [(key, rows_text(case[key], text)) for key in INPUTS]
        members += [(key, json.dumps(case[key])) for key in ("faces", "indices")]
    bits = [("threshold", quoted(case["threshold"]))]
    bits += [(key, rows_text(case[key], quoted)) for key in INPUTS if key in case]
    expected = case.get("expected", {})
    if "sha256" in expected:
        sample = expected["sample"]
        rows = [("corners", json.dumps(sample["corners"]))]
        rows += [(key, rows_text(sample[key], text)) for key in ("tangents", *MODES) if key in sample]
        members.append(("expected", object_text([("sha256", f'"{expected["sha256"]}"'), ("sample", object_text(rows))])))
    elif expected:
        keys = [key for key in (*OUTPUTS, *MODES) if key in expected]
        members.append(("expected", object_text((key, rows_text(expected[key], text)) for key in keys)))
        bits += [(key, rows_text(expected[key], quoted)) for key in OUTPUTS]
    if "positions" in case:
        members.append(("bits", object_text(bits)))
    lines = ",\n".join(f' "{key}": {value}' for key, value in members)
    Path(path).write_text("{\n" + lines + "\n}\n", encoding="utf-8")


def object_text(members):
    return "{\n" + ",\n".join(f'  "{key}": {value}' for key, value in members) + "\n }"
