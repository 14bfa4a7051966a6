"""Writes a case as a GLB file and reads tangents back per corner, for tools that convert files. Copy it. Licence: CC0."""

import json
import struct
from pathlib import Path

# A grey pixel as PNG; a material with a normal map makes tools keep or make tangents.
PIXEL = (
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR4nGNoaGj4DwAFhAKAjM1mJgAAAABJRU5ErkJggg=="
)
FLOAT, UNSIGNED = 5126, 5125


def check(case):
    """Raises the reason for skipping a case that glTF cannot hold."""
    if set(case["faces"]) - {3}:
        raise ValueError("skip: triangles only")
    if case["threshold"] != 180.0:
        raise ValueError("skip: no angular threshold")
    if not case["faces"]:
        raise ValueError("skip: glTF has no meshes without triangles")
    if any(x - x != 0.0 for key in ("positions", "normals", "uvs") for row in case[key] for x in row):
        raise ValueError("skip: glTF has finite numbers only")


def write_glb(path, case):
    """One mesh of one primitive. UVs are stored as they are, so a correct tool gives the negated sign (glTF's v points down)."""
    chunks, views, accessors = [], [], []

    def accessor(data, component, kind, count, bounds=None):
        views.append({"buffer": 0, "byteOffset": sum(map(len, chunks)), "byteLength": len(data)})
        chunks.append(data + b"\0" * (-len(data) % 4))
        accessors.append({"bufferView": len(views) - 1, "componentType": component, "count": count, "type": kind, **(bounds or {})})
        return len(accessors) - 1

    def rows(key, width):
        data = b"".join(struct.pack(f"<{width}f", *row) for row in case[key])
        columns = list(zip(*case[key]))
        bounds = {"min": [min(c) for c in columns], "max": [max(c) for c in columns]} if key == "positions" else None
        return accessor(data, FLOAT, f"VEC{width}", len(case[key]), bounds)

    attributes = {"POSITION": rows("positions", 3), "NORMAL": rows("normals", 3), "TEXCOORD_0": rows("uvs", 2)}
    indices = accessor(struct.pack(f"<{len(case['indices'])}I", *case["indices"]), UNSIGNED, "SCALAR", len(case["indices"]))
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "name": "case"}],
        "meshes": [{"name": "case", "primitives": [{"attributes": attributes, "indices": indices, "material": 0}]}],
        "materials": [{"name": "m", "normalTexture": {"index": 0}, "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
        "textures": [{"source": 0}],
        "images": [{"uri": f"data:image/png;base64,{PIXEL}"}],
        "bufferViews": views,
        "accessors": accessors,
        "buffers": [{"byteLength": sum(map(len, chunks))}],
    }
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    body = b"".join(chunks)
    head = struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(body))
    Path(path).write_bytes(head + struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(body), b"BIN\0") + body)


def read_glb(path):
    """All triangles of a file: lists of (position, normal, uv, tangent or None) by threes."""
    data = Path(path).read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    document, body = json.loads(data[20 : 20 + length]), data[28 + length :]
    kinds = {5120: ("b", 127), 5121: ("B", 255), 5122: ("h", 32767), 5123: ("H", 65535), UNSIGNED: ("I", 1), FLOAT: ("f", 1)}

    def read(index):
        accessor = document["accessors"][index]
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}[accessor["type"]]
        code, whole = kinds[accessor["componentType"]]
        if "bufferView" not in accessor:
            return [(0.0,) * width] * accessor["count"]
        view = document["bufferViews"][accessor["bufferView"]]
        stride = view.get("byteStride") or width * struct.calcsize(code)
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        rows = [struct.unpack_from(f"<{width}{code}", body, start + stride * i) for i in range(accessor["count"])]
        return [tuple(max(x / whole, -1.0) for x in row) for row in rows] if accessor.get("normalized") else rows

    corners = []
    for mesh in document.get("meshes", []):
        for primitive in mesh["primitives"]:
            attributes = primitive["attributes"]
            columns = [read(attributes[key]) for key in ("POSITION", "NORMAL", "TEXCOORD_0")]
            columns.append(read(attributes["TANGENT"]) if "TANGENT" in attributes else [None] * len(columns[0]))
            vertices = list(zip(*columns))
            order = [row[0] for row in read(primitive["indices"])] if "indices" in primitive else range(len(vertices))
            corners += [vertices[index] for index in order]
    return corners


def tangents_per_corner(case, corners, digits=4):
    """The tangents of a converted file at the corners of the case, whose triangles may be in another order or begin elsewhere.

    Corners are found by position, normal and UV, rounded to `digits`; first whole triangles, then single corners. A corner that the file lacks
    gets a zero vector, which fails. Signs are negated, from glTF's to MikkTSpace's.
    """

    def key(position, normal, uv):
        size = sum(x * x for x in normal) ** 0.5 or 1.0
        return tuple(round(x, digits) + 0.0 for x in (*position, *(x / size for x in normal), *uv))

    whole, single = {}, {}
    for at in range(0, len(corners) - 2, 3):
        triangle = [(key(*corner[:3]), corner[3]) for corner in corners[at : at + 3]]
        for turn in range(3):
            turned = triangle[turn:] + triangle[:turn]
            whole.setdefault(tuple(k for k, _ in turned), []).append([tangent for _, tangent in turned])
        for k, tangent in triangle:
            single.setdefault(k, tangent)
    found = []
    for at in range(0, len(case["indices"]), 3):
        keys = tuple(key(*(case[name][index] for name in ("positions", "normals", "uvs"))) for index in case["indices"][at : at + 3])
        found += whole[keys][0] if keys in whole else [single.get(k) for k in keys]
    return [(t[0], t[1], t[2], -t[3]) if t else (0.0,) * 4 for t in found]
