"""Writes a case as a GLB file and reads tangents back per corner, for tools that convert files. Copy it. Licence: CC0."""

import itertools
import json
import struct
from pathlib import Path

# A grey pixel as PNG; a material with a normal map makes tools keep or make tangents.
PIXEL = (
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR4nGNoaGj4DwAFhAKAjM1mJgAAAABJRU5ErkJggg=="
)
MAPPED = {"name": "m", "normalTexture": {"index": 0}, "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}
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


def write_glb(path, case, tangents=None):
    """One mesh of one primitive. UVs are stored as they are, so a correct tool gives the negated sign (glTF's v points down).

    With tangents, one per corner in MikkTSpace's sign, each corner is a vertex, and there is no normal map.
    """
    order = list(range(len(case["indices"]))) if tangents else case["indices"]
    chunks, views, accessors = [], [], []

    def accessor(data, component, kind, count, bounds=None):
        views.append({"buffer": 0, "byteOffset": sum(map(len, chunks)), "byteLength": len(data)})
        chunks.append(data + b"\0" * (-len(data) % 4))
        accessors.append({"bufferView": len(views) - 1, "componentType": component, "count": count, "type": kind, **(bounds or {})})
        return len(accessors) - 1

    def rows(values, width, is_bounded=False):
        data = b"".join(struct.pack(f"<{width}f", *row) for row in values)
        columns = list(zip(*values))
        bounds = {"min": [min(c) for c in columns], "max": [max(c) for c in columns]} if is_bounded else None
        return accessor(data, FLOAT, f"VEC{width}", len(values), bounds)

    def vertices(key):
        return [case[key][index] for index in case["indices"]] if tangents else case[key]

    attributes = {"POSITION": rows(vertices("positions"), 3, True), "NORMAL": rows(vertices("normals"), 3), "TEXCOORD_0": rows(vertices("uvs"), 2)}
    if tangents:
        attributes["TANGENT"] = rows([(x, y, z, -w) for x, y, z, w in tangents], 4)
    material = {"name": "m", "pbrMetallicRoughness": {"metallicFactor": 0}} if tangents else MAPPED
    indices = accessor(struct.pack(f"<{len(order)}I", *order), UNSIGNED, "SCALAR", len(order))
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "name": "case"}],
        "meshes": [{"name": "case", "primitives": [{"attributes": attributes, "indices": indices, "material": 0}]}],
        "materials": [material],
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


def read_glb(path, names=None):
    """All triangles of a file, or of its meshes of these names: lists of (position, normal, uv, tangent or None) by threes."""
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
    meshes = [mesh for mesh in document.get("meshes", []) if names is None or mesh.get("name") in names]
    for mesh in meshes:
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

    Corners are found by position, normal and UV, rounded to `digits`; first whole triangles, then single corners. Numbers that round up here and
    down there count as equal. A corner that the file lacks gets a zero vector, which fails. Signs are negated, from glTF's to MikkTSpace's.
    """
    unit = 10.0**-digits

    def key(position, normal, uv):
        size = sum(x * x for x in normal) ** 0.5 or 1.0
        return tuple(round(x, digits) + 0.0 for x in (*position, *(x / size for x in normal), *uv))

    whole, single, by_position = {}, {}, {}
    for at in range(0, len(corners) - 2, 3):
        triangle = [(key(*corner[:3]), corner[3]) for corner in corners[at : at + 3]]
        for turn in range(3):
            turned = triangle[turn:] + triangle[:turn]
            whole.setdefault(tuple(k for k, _ in turned), [tangent for _, tangent in turned])
            by_position.setdefault(turned[0][0][:3], []).append(turned)
        for k, tangent in triangle:
            single.setdefault(k, tangent)

    def similar(keys):
        """The tangents of the first triangle whose corners from its first one on are these but for the last digit."""
        for steps in itertools.product((0.0, unit, -unit), repeat=3):
            cell = tuple(round(x + step, digits) + 0.0 for x, step in zip(keys[0], steps))
            for triangle in by_position.get(cell, ()):
                if all(abs(x - y) < 1.5 * unit for k, (other, _) in zip(keys, triangle) for x, y in zip(k, other)):
                    return [tangent for _, tangent in triangle]
        return None

    def of_corner(k):
        return single[k] if k in single else (similar([k]) or [None])[0]

    found = []
    for at in range(0, len(case["indices"]), 3):
        keys = tuple(key(*(case[name][index] for name in ("positions", "normals", "uvs"))) for index in case["indices"][at : at + 3])
        found += whole.get(keys) or similar(keys) or map(of_corner, keys)
    return [(t[0], t[1], t[2], -t[3]) if t else (0.0,) * 4 for t in found]
