"""What Python costs over Rust on a grid of a million triangles: the numbers of docs/notes/python.md.

Both are asked in turns, three times, each for the least of 15 calls. Install a release build first.
"""

import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any, Callable, Dict, List

import darboux
import numpy as np

ROOT = Path(__file__).resolve().parents[3]


def rust(folder: str, threads: int) -> Dict[str, float]:
    command = ["cargo", "run", "--quiet", "--release", "--package", "darboux-tests", "--bin", "speed", folder]
    environment = {**os.environ, "RAYON_NUM_THREADS": str(threads)}
    return dict(json.loads(subprocess.run(command, cwd=ROOT, env=environment, check=True, stdout=subprocess.PIPE).stdout))


def least(call: Callable[[], Any]) -> float:
    """The least of 15 times, in milliseconds."""
    times: List[float] = []
    for _ in range(15):
        start = time.perf_counter()
        call()
        times.append(1000 * (time.perf_counter() - start))
    return min(times)


def python(arrays: Dict[str, np.ndarray], threads: int) -> Dict[str, float]:
    vertices = np.hstack([arrays["positions"], arrays["normals"], arrays["uvs"]])
    strided = {"positions": vertices[:, 0:3], "normals": vertices[:, 3:6], "uvs": vertices[:, 6:8]}
    doubles = {name: rows.astype(np.float64) for name, rows in arrays.items() if name != "indices"}
    tangents = darboux.generate_tangents(**arrays)
    forms: Dict[str, Dict[str, Any]] = {
        "fresh": arrays,
        "out=": {**arrays, "out": tangents},
        "strided": {**strided, "indices": arrays["indices"]},
        "int64 indices": {**arrays, "indices": arrays["indices"].astype(np.int64)},
        "float64": {**doubles, "indices": arrays["indices"]},
    }
    found = {name: least(lambda: darboux.generate_tangents(**form, threads=threads)) for name, form in forms.items()}
    found["split"] = least(lambda: darboux.split_vertices(arrays["indices"], tangents, len(vertices)))
    return found


def small_call() -> float:
    """Microseconds of a call for two triangles."""
    quad = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=np.float32)
    uvs, indices = quad[:, :2].copy(), np.array([[0, 1, 2], [0, 2, 3]], dtype=np.uint32)

    def calls() -> None:
        for _ in range(1000):
            darboux.generate_tangents(quad, quad, uvs, indices)

    return least(calls)


def main() -> int:
    with tempfile.TemporaryDirectory() as folder:
        for threads in (1, os.cpu_count() or 1):
            for _ in range(3):
                ours = rust(folder, threads)
                arrays = {
                    name: np.fromfile(f"{folder}/{name}", dtype=np.float32).reshape(-1, columns)
                    for name, columns in (("positions", 3), ("normals", 3), ("uvs", 2))
                }
                arrays["indices"] = np.fromfile(f"{folder}/indices", dtype=np.uint32)
                found = python(arrays, threads)
                print(f"{threads} threads, milliseconds: Rust", *(f"{name} {ms:.1f}," for name, ms in ours.items()), end=" ")
                print("Python", *(f"{name} {ms:.1f}," for name, ms in found.items()), flush=True)
    print(f"two triangles: {small_call():.2f} microseconds a call")
    return 0


if __name__ == "__main__":
    sys.exit(main())
