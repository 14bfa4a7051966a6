"""What Python costs over Rust on grids of two to a million triangles: the tables of docs/notes/python.md.

Both are asked in turns, three times, each for the least of 15 times; printed is the least of all. Install a release build first.
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

Times = Dict[str, float]
"""Milliseconds of a call, by name."""


def rust(folder: str, threads: int) -> Dict[str, Times]:
    command = ["cargo", "run", "--quiet", "--release", "--package", "darboux-tests", "--bin", "speed", folder]
    environment = {**os.environ, "RAYON_NUM_THREADS": str(threads)}
    return dict(json.loads(subprocess.run(command, cwd=ROOT, env=environment, check=True, stdout=subprocess.PIPE).stdout))


def least(calls: int, call: Callable[[], Any]) -> float:
    """The least of 15 times, in milliseconds a call."""
    times: List[float] = []
    for _ in range(15):
        start = time.perf_counter()
        for _ in range(calls):
            call()
        times.append(1000 * (time.perf_counter() - start) / calls)
    return min(times)


def python(arrays: Dict[str, np.ndarray], threads: int, triangles: int) -> Times:
    vertices = np.hstack([arrays["positions"], arrays["normals"], arrays["uvs"]])
    strided = {"positions": vertices[:, 0:3], "normals": vertices[:, 3:6], "uvs": vertices[:, 6:8]}
    doubles = {name: rows.astype(np.float64) for name, rows in arrays.items() if name != "indices"}
    halves = {name: rows.astype(np.float16) for name, rows in arrays.items() if name != "indices"}
    tangents = darboux.generate_tangents(**arrays)
    plan = darboux.Plan(**arrays)
    calls = min(max(100_000 // triangles, 1), 1000)
    forms: Dict[str, Dict[str, Any]] = {
        "fresh": arrays,
        "out=": {**arrays, "out": tangents},
        "interleaved": {**strided, "indices": arrays["indices"]},
        "int64 indices": {**arrays, "indices": arrays["indices"].astype(np.int64)},
        "float64": {**doubles, "indices": arrays["indices"]},
        "float16": {**halves, "indices": arrays["indices"]},
        "full": {**arrays, "full": True},
    }
    found = {}
    for name, form in forms.items():
        found[name] = least(calls, lambda: darboux.generate_tangents(**form, threads=threads))
    found["split"] = least(calls, lambda: darboux.split_vertices(arrays["indices"], tangents, len(vertices)))
    moved = (arrays["positions"], arrays["normals"])
    found["Plan, out="] = least(calls, lambda: plan.evaluate(*moved, threads=threads, out=tangents))
    return found


def grid(folder: Path) -> Dict[str, np.ndarray]:
    rows = (("positions", 3), ("normals", 3), ("uvs", 2))
    arrays: Dict[str, np.ndarray] = {
        name: np.fromfile(folder / name, dtype=np.float32).reshape(-1, columns) for name, columns in rows
    }
    return {**arrays, "indices": np.fromfile(folder / "indices", dtype=np.uint32)}


def keep_least(all_times: Dict[str, Times], size: str, times: Times) -> None:
    kept = all_times.setdefault(size, times)
    kept.update({name: min(ms, kept[name]) for name, ms in times.items()})


def main() -> int:
    with tempfile.TemporaryDirectory() as folder:
        for threads in (1, os.cpu_count() or 1):
            ours: Dict[str, Times] = {}
            found: Dict[str, Times] = {}
            for _ in range(3):
                for size, times in rust(folder, threads).items():
                    keep_least(ours, size, times)
                    keep_least(found, size, python(grid(Path(folder) / size), threads, int(size)))
            for size in ours:
                print(f"{threads} threads, {size} triangles")
                for side, table in (("Rust", ours[size]), ("Python", found[size])):
                    for name, ms in table.items():
                        print(f"  {side:6} {name:14} {ms:10.4f} ms {1000 / ms:12.0f} calls a second")
    return 0


if __name__ == "__main__":
    sys.exit(main())
