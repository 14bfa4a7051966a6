"""Meshes for the tests: the collected ones with Rust's answers, and plain ones."""

import json
import os
import signal
import subprocess
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Dict, List, Optional, Tuple

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[3]

# Shells ignore Ctrl-C for what they start in the background, and so would this process and all that it starts.
signal.signal(signal.SIGINT, signal.default_int_handler)


def bits(array: np.ndarray) -> List[int]:
    """The bits of an array's floats, all NaNs the same: processors do not agree on their signs."""
    array = np.ascontiguousarray(array, dtype=np.float32)
    return np.where(np.isnan(array), np.float32(np.nan), array).view(np.uint32).ravel().tolist()


@dataclass
class Mesh:
    positions: np.ndarray
    normals: np.ndarray
    uvs: np.ndarray
    indices: Optional[np.ndarray]

    @property
    def arrays(self) -> Tuple[Any, ...]:
        return (self.positions, self.normals, self.uvs, self.indices)


@dataclass
class CorpusCase:
    """A collected mesh, options, and what Rust makes of it."""

    options: Dict[str, Any]
    mesh: Mesh
    faces: np.ndarray
    answer: Dict[str, Any]

    def floats(self, name: str, columns: int) -> np.ndarray:
        """Rust's answer of that name."""
        return floats(self.answer[name], columns)


def floats(words: List[int], columns: int) -> np.ndarray:
    return np.array(words, dtype=np.uint32).view(np.float32).reshape(-1, columns)


def corpus_case(line: str) -> CorpusCase:
    read = json.loads(line)
    mesh = Mesh(
        floats(read["positions"], 3),
        floats(read["normals"], 3),
        floats(read["uvs"], 2),
        np.array(read["indices"], dtype=np.uint32),
    )
    options = {"mode": read["mode"], "threshold": read["threshold"]}
    return CorpusCase(options, mesh, np.array(read["faces"], dtype=np.uint32), read)


@pytest.fixture(scope="session")
def corpus() -> List[CorpusCase]:
    command = ["cargo", "run", "--quiet", "--package", "darboux-tests", "--bin", "corpus"]
    output = subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE, env=os.environ)
    return [corpus_case(line) for line in output.stdout.decode().splitlines()]


def grid(columns: int, rows: int) -> Mesh:
    """A wavy sheet of 2 * columns * rows triangles, its texture mirrored at the middle."""
    x, y = np.meshgrid(np.linspace(-1, 1, columns + 1), np.linspace(-1, 1, rows + 1), indexing="xy")
    positions = np.stack([x, y, 0.2 * np.sin(3 * x) * np.cos(2 * y)], -1).reshape(-1, 3)
    slopes = np.stack(
        [-0.6 * np.cos(3 * x) * np.cos(2 * y), 0.4 * np.sin(3 * x) * np.sin(2 * y), np.ones_like(x)], -1
    ).reshape(-1, 3)
    normals = slopes / np.linalg.norm(slopes, axis=1, keepdims=True)
    uvs = np.stack([np.abs(x), y], -1).reshape(-1, 2)
    first = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).reshape(-1, 1)
    quads = first + np.array([0, 1, columns + 2, columns + 1])
    triangles = quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
    return Mesh(
        positions.astype(np.float32), normals.astype(np.float32), uvs.astype(np.float32), triangles.astype(np.uint32)
    )


@pytest.fixture(scope="session")
def sheet() -> Mesh:
    return grid(10, 7)
