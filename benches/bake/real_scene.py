"""Bakes a real scene: simplifies a model, lays it out anew, bakes all maps by one job, and compares pictures of both.

    python3 benches/bake/real_scene.py MODEL.glb FOLDER [--share 0.3] [--size 2048] [--samples 4] [--darboux PATH] [--jobs 2]

Needs numpy, pillow, meshoptimizer and xatlas (pip), and a darboux with the features bake and gpu. MODEL is a GLB whose primitives become parts:
NAME_high in high.glb, NAME_low in low.glb with one UV layout for all. The job bakes each low part from its high part. low.png and original.png are drawn from
the same places; the errors of the pictures are printed for each distance.
"""

import argparse
import json
import struct
import subprocess
import time
from pathlib import Path
from typing import Any, Dict, List, Tuple

import meshoptimizer
import numpy as np
import xatlas
from PIL import Image

MAPS = "normal,object-normal,height,ao,position,bent-normal,thickness,curvature,id,base-color,opacity,roughness,metalness,emission,world-direction,uv-islands,wireframe"
VIEWS = {"front": (30, 20), "right": (120, 20), "behind": (210, 35), "left": (300, 20)}
"""Degrees around the model and above the horizon."""
DISTANCES = {"near": 2.0, "far": 9.0}
"""In radii of the original. From far away, mip levels of the maps are seen."""
TYPES = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


class Glb:
    """The JSON and the bytes of a GLB without compression."""

    def __init__(self, path: Path) -> None:
        data = path.read_bytes()
        length = struct.unpack("<I", data[12:16])[0]
        self.json: Dict[str, Any] = json.loads(data[20 : 20 + length])
        self.bytes = bytearray(data[28 + length :])

    def array(self, accessor: int) -> np.ndarray:
        found = self.json["accessors"][accessor]
        view = self.json["bufferViews"][found["bufferView"]]
        kind, columns = np.dtype(TYPES[found["componentType"]]), COMPONENTS[found["type"]]
        stride = view.get("byteStride", kind.itemsize * columns)
        first = view.get("byteOffset", 0) + found.get("byteOffset", 0)
        rows = np.ndarray((found["count"], columns), kind, self.bytes, first, (stride, kind.itemsize))
        return rows.copy()

    def add(self, array: np.ndarray, kind: str) -> int:
        self.bytes += b"\0" * (-len(self.bytes) % 4)
        view = {"buffer": 0, "byteOffset": len(self.bytes), "byteLength": array.nbytes}
        self.bytes += array.tobytes()
        self.json["bufferViews"].append(view)
        code = next(code for code, known in TYPES.items() if known == array.dtype)
        accessor = {"bufferView": len(self.json["bufferViews"]) - 1, "componentType": code, "count": len(array), "type": kind}
        if kind == "VEC3":
            accessor.update(min=array.min(0).tolist(), max=array.max(0).tolist())
        self.json["accessors"].append(accessor)
        return len(self.json["accessors"]) - 1

    def save(self, path: Path) -> None:
        self.bytes += b"\0" * (-len(self.bytes) % 4)
        self.json["buffers"] = [{"byteLength": len(self.bytes)}]
        text = json.dumps(self.json).encode()
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(self.bytes), 0x004E4942) + self.bytes
        path.write_bytes(b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks)


Part = Tuple[str, np.ndarray, np.ndarray, np.ndarray]
"""Name, positions, normals, indices."""


def split_into_parts(glb: Glb) -> List[Part]:
    """Gives each primitive a mesh and a node of its own: NAME_high."""
    parts, meshes = [], []
    for mesh in glb.json["meshes"]:
        for primitive in mesh["primitives"]:
            material = primitive.get("material")
            name = f"part{len(parts)}" if material is None else glb.json["materials"][material].get("name", f"part{material}")
            name = f"{name.replace(' ', '_').lower()}{len(parts)}"
            meshes.append({"name": f"{name}_high", "primitives": [primitive]})
            positions, normals = (glb.array(primitive["attributes"][key]) for key in ("POSITION", "NORMAL"))
            parts.append((name, positions, normals, glb.array(primitive["indices"]).astype(np.uint32).ravel()))
    glb.json["meshes"] = meshes
    glb.json["nodes"] = [{"mesh": at, "name": mesh["name"]} for at, mesh in enumerate(meshes)]
    glb.json["scenes"] = [{"nodes": list(range(len(meshes)))}]
    return parts


def simplified(part: Part, share: float) -> Part:
    """The part with a share of its triangles, by meshoptimizer; vertices that differ in their normals only are welded first."""
    name, positions, normals, indices = part
    _, first, welded = np.unique(positions, axis=0, return_index=True, return_inverse=True)
    positions = np.ascontiguousarray(positions[first], np.float32)
    indices = welded.ravel()[indices].astype(np.uint32)
    target = max(12, int(len(indices) * share) // 3 * 3)
    out = np.zeros_like(indices)
    count = meshoptimizer.simplify(out, indices, positions, target_index_count=target, target_error=0.05)
    used, kept = np.unique(out[:count], return_inverse=True)
    positions, triangles = positions[used], kept.reshape(-1, 3).astype(np.uint32)
    return name, positions, smooth_normals(positions, triangles), triangles.ravel()


def smooth_normals(positions: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    corners = positions[triangles]
    faces = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = np.zeros_like(positions)
    for corner in range(3):
        np.add.at(normals, triangles[:, corner], faces)
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.where(lengths > 0, normals / np.maximum(lengths, 1e-30), [0, 0, 1]).astype(np.float32)


def save_low(parts: List[Part], path: Path) -> None:
    """Lays the parts out together by xatlas and writes them with one material."""
    atlas = xatlas.Atlas()
    for _, positions, normals, indices in parts:
        atlas.add_mesh(positions, indices.reshape(-1, 3), normals)
    pack = xatlas.PackOptions()
    pack.padding, pack.resolution, pack.bilinear = 4, 2048, True
    atlas.generate(pack_options=pack)
    glb = Glb.__new__(Glb)
    glb.bytes = bytearray()
    glb.json = {"asset": {"version": "2.0"}, "scene": 0, "accessors": [], "bufferViews": [], "meshes": [], "nodes": []}
    glb.json["materials"] = [{"name": "baked", "doubleSided": True}]
    for at, (name, positions, normals, _) in enumerate(parts):
        source, triangles, uvs = atlas[at]
        attributes = {
            "POSITION": glb.add(positions[source], "VEC3"),
            "NORMAL": glb.add(normals[source], "VEC3"),
            "TEXCOORD_0": glb.add(np.ascontiguousarray(uvs, np.float32), "VEC2"),
        }
        indices = glb.add(np.ascontiguousarray(triangles, np.uint32).reshape(-1, 1), "SCALAR")
        glb.json["meshes"].append({"name": f"{name}_low", "primitives": [{"attributes": attributes, "indices": indices, "material": 0}]})
        glb.json["nodes"].append({"name": f"{name}_low", "mesh": at})
    glb.json["scenes"] = [{"nodes": list(range(len(parts)))}]
    glb.save(path)


def camera(parts: List[Part], angles: Tuple[int, int], radii: float) -> str:
    """The same place for both models: around the middle of the original, whose box simplification changes."""
    all_positions = np.concatenate([positions for _, positions, _, _ in parts])
    low, high = all_positions.min(0), all_positions.max(0)
    middle, radius = (low + high) / 2, float(np.linalg.norm(high - low)) / 2
    yaw, pitch = np.radians(angles)
    away = np.array([np.sin(yaw) * np.cos(pitch), np.sin(pitch), np.cos(yaw) * np.cos(pitch)])
    return ",".join(f"{x:.6f}" for x in [*(middle + radii * radius * away), *middle])


def error(first: Path, second: Path) -> Dict[str, float]:
    """The root mean square error of two pictures where either shows the model, and of the whole; 1 is black against white."""
    a, b = (np.asarray(Image.open(path).convert("RGB"), np.float64) / 255 for path in (first, second))
    squares = ((a - b) ** 2).mean(2)
    model = (np.abs(a - a[0, 0]).max(2) > 0) | (np.abs(b - b[0, 0]).max(2) > 0)
    return {"of the model": float(np.sqrt(squares[model].mean())), "of the picture": float(np.sqrt(squares.mean()))}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("model", type=Path)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--share", type=float, default=0.3, help="of the triangles that the low model keeps")
    parser.add_argument("--size", type=int, default=2048)
    parser.add_argument("--samples", type=int, default=4)
    parser.add_argument("--darboux", default="darboux")
    parser.add_argument("--jobs", type=int, default=0)
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    folder = options.folder.resolve()

    def darboux(*arguments: object) -> None:
        subprocess.run([options.darboux, *map(str, arguments)], check=True)

    # Decodes compressed meshes, and splits vertices as the renderer needs them.
    darboux("tangents", options.model, "-o", folder / "decoded.glb", "--force", "--quiet")
    high = Glb(folder / "decoded.glb")
    parts = split_into_parts(high)
    high.save(folder / "high.glb")
    low = [simplified(part, options.share) for part in parts]
    save_low(low, folder / "low.glb")
    for (name, _, _, before), (_, _, _, after) in zip(parts, low):
        print(f"{name:24}{len(before) // 3:8} -> {len(after) // 3}")
    job = [f'map = [{", ".join(json.dumps(kind) for kind in MAPS.split(","))}]', f"size = {options.size}", f"samples = {options.samples}"]
    job += ['match = "name"', "auto-cage = true", "ao-rays = 32", "verify = true", 'write-model = "baked.glb"', 'write-cage = "cage.glb"']
    job += ["", "[[bake]]", 'low = "low.glb"', 'high = "high.glb"', 'output = "scene.png"']
    (folder / "job.toml").write_text("[defaults]\n" + "\n".join(job) + "\n")
    start = time.monotonic()
    darboux("bake", folder / "job.toml", "--force", *(["--jobs", options.jobs] if options.jobs else []))
    print(f"baked in {time.monotonic() - start:.1f} s")
    for distance, radii in DISTANCES.items():
        for view, angles in VIEWS.items():
            pictures = []
            for model in ("high", "baked", "low"):
                pictures.append(folder / f"{view}-{distance}.{model}.png")
                look = camera(parts, angles, radii)
                darboux("render", folder / f"{model}.glb", "-o", pictures[-1], f"--look={look}", "--no-legend", "--force", "--quiet")
            baked, bare = error(pictures[0], pictures[1]), error(pictures[0], pictures[2])
            print(f"{view + ', ' + distance:16}" + "".join(f"  RMSE {what} {baked[what]:.4f} (without maps {bare[what]:.4f})" for what in baked))


main()
