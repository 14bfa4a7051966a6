"""Threads, forked processes and memory."""

import gc
import json
import multiprocessing
import signal
import struct
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Callable, Dict, List

import darboux
import numpy as np
import pytest
from conftest import Mesh, grid


def large() -> Mesh:
    """Large enough for more than one thread."""
    return grid(200, 150)


def quads() -> Mesh:
    """Too few corners for a second thread, though enough triangles for one once the quads are cut."""
    mesh = grid(100, 100)
    assert mesh.indices is not None
    return Mesh(mesh.positions, mesh.normals, mesh.uvs, mesh.indices.reshape(-1, 6)[:, [0, 1, 2, 5]].copy())


def test_results_outlive_inputs() -> None:
    mesh = large()
    tangents = darboux.generate_tangents(*mesh.arrays)
    before = tangents.copy()
    del mesh
    gc.collect()
    assert np.array_equal(tangents, before)


def long_calls() -> Dict[str, Callable[[], object]]:
    """What takes long on the thread that calls it."""
    mesh = grid(300, 300)
    corners = np.tile(mesh.normals, (6, 1))
    tangents = np.concatenate([corners, np.ones((len(corners), 1), np.float32)], axis=1)
    codes = darboux.encode.frame_to_quaternion(corners, tangents)
    model = darboux.loads(large_model())
    return {
        "generate_tangents": lambda: darboux.generate_tangents(*mesh.arrays, threads=1),
        "convert": lambda: darboux.convert("gltf", "unity", positions=corners, tangents=tangents, indices=np.arange(600_000, dtype=np.uint32)),
        "tangent_to_diamond": lambda: darboux.encode.tangent_to_diamond(corners, tangents),
        "frame_from_quaternion": lambda: darboux.encode.frame_from_quaternion(codes),
        "Document.arrays": lambda: model.arrays(),
    }


def large_model() -> bytes:
    """A GLB of one primitive with many positions and normals."""
    count = 300_000
    accessor = {"bufferView": 0, "componentType": 5126, "count": count, "type": "VEC3", "min": [0, 0, 0], "max": [0, 0, 0]}
    gltf = {
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": 12 * count}],
        "bufferViews": [{"buffer": 0, "byteLength": 12 * count}],
        "accessors": [accessor],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 0}, "mode": 0}]}],
    }
    text = json.dumps(gltf).encode()
    text += b" " * (-len(text) % 4)
    header = struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + 12 * count)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", 12 * count, b"BIN\0")
    return header + chunks + bytes(12 * count)


def lets_others_run(call: Callable[[], object]) -> bool:
    """Whether another thread of Python's runs during one of many calls. Nothing takes the GIL from a thread here: it has to give it."""
    turns, done = [0], threading.Event()

    def take_turns() -> None:
        while not done.is_set():
            turns[0] += 1
            time.sleep(0)

    other, interval = threading.Thread(target=take_turns), sys.getswitchinterval()
    sys.setswitchinterval(100)
    other.start()
    try:
        for _ in range(200):
            before = turns[0]
            call()
            if turns[0] != before:
                return True
        return False
    finally:
        done.set()
        sys.setswitchinterval(interval)
        other.join()


@pytest.mark.parametrize("name", long_calls())
def test_other_threads_run_meanwhile(name: str) -> None:
    assert lets_others_run(long_calls()[name])


def test_a_call_that_keeps_the_gil_is_seen() -> None:
    assert not lets_others_run(lambda: sorted(range(2000)))


@pytest.mark.parametrize("type_of_index", ["u2", "u4"])
def test_indices_that_another_thread_changes_meanwhile(type_of_index: str) -> None:
    """A call either returns or refuses the mesh: it reads the indices once, before it checks them."""
    mesh = grid(120, 120)
    positions, normals, uvs, indices = mesh.arrays
    indices = indices.astype(type_of_index)
    good, bad, done = indices.copy(), np.full_like(indices, np.iinfo(type_of_index).max), threading.Event()

    def change() -> None:
        while not done.is_set():
            indices[:] = bad
            indices[:] = good

    other = threading.Thread(target=change)
    other.start()
    try:
        for _ in range(200):
            try:
                darboux.generate_tangents(positions, normals, uvs, indices)
            except ValueError as error:
                assert "out of range" in str(error)
    finally:
        done.set()
        other.join()


def test_many_threads_get_the_same() -> None:
    mesh = large()
    expected = darboux.generate_tangents(*mesh.arrays).tobytes()
    found: List[bytes] = []
    work = [
        threading.Thread(target=lambda: found.append(darboux.generate_tangents(*mesh.arrays).tobytes()))
        for _ in range(8)
    ]
    for thread in work:
        thread.start()
    for thread in work:
        thread.join()
    assert found == [expected] * 8


def hash_of_tangents(mesh: Mesh) -> int:
    return hash(darboux.generate_tangents(*mesh.arrays).tobytes().hex())


@pytest.mark.skipif(sys.platform == "win32", reason="no fork")
@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")
@pytest.mark.parametrize("mesh", [large(), quads()], ids=["large", "quads"])
def test_forked_processes_work(mesh: Mesh) -> None:
    """A child has none of its parent's threads; it must not wait for them."""
    expected = hash_of_tangents(mesh)
    with multiprocessing.get_context("fork").Pool(2) as pool:
        assert pool.map_async(hash_of_tangents, [mesh] * 4).get(timeout=60) == [expected] * 4


def threads_started_by_quads() -> int:
    mesh, threads = quads(), Path("/proc/self/task")
    before = len(list(threads.iterdir()))
    darboux.generate_tangents(*mesh.arrays, threads=1)
    return len(list(threads.iterdir())) - before


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")
def test_few_corners_start_no_thread() -> None:
    """In a process of its own, where nothing has started any."""
    program = "import test_processes; print(test_processes.threads_started_by_quads())"
    ran = subprocess.run([sys.executable, "-c", program], cwd=Path(__file__).parent, check=True, capture_output=True)
    assert ran.stdout.split() == [b"0"]


@pytest.mark.skipif(sys.platform == "win32", reason="signals of Unix")
def test_ctrl_c_during_arrays() -> None:
    """It is raised, from a call or between two, and calls go on working."""
    mesh = grid(300, 300)
    expected = darboux.generate_tangents(*mesh.arrays).tobytes()
    called = threading.Event()

    def interrupt() -> None:
        called.wait()
        signal.pthread_kill(threading.main_thread().ident or 0, signal.SIGINT)

    thread = threading.Thread(target=interrupt)
    thread.start()
    with pytest.raises(KeyboardInterrupt):
        while True:
            assert darboux.generate_tangents(*mesh.arrays).tobytes() == expected
            called.set()
    thread.join()
    assert darboux.generate_tangents(*mesh.arrays).tobytes() == expected


def fan(triangles: int) -> Mesh:
    """All around one vertex, each turned against the next: below 180 degrees their groups take the square of their number."""
    turns = np.linspace(0, 6, triangles + 1)
    rim = np.stack([np.cos(turns), np.sin(turns), 0.1 * np.sin(900 * turns)], -1)
    positions = np.concatenate([np.zeros((1, 3)), rim])
    normals = np.broadcast_to([0.0, 0.0, 1.0], positions.shape)
    uvs = positions[:, :2] * [1, 2]
    first = np.arange(1, triangles + 1)
    return Mesh(positions, normals, uvs, np.stack([np.zeros_like(first), first, first + 1], -1))


SLOW: Dict[str, Callable[[Mesh], object]] = {
    "tangents": lambda mesh: darboux.generate_tangents(*mesh.arrays, threshold=1),
    "frames": lambda mesh: darboux.generate_tangents(*mesh.arrays, threshold=1, full=True),
    "Plan": lambda mesh: darboux.Plan(*mesh.arrays, threshold=1),
}


def interrupt_what_would_take_minutes(name: str) -> None:
    mesh = fan(400_000)

    def compute() -> None:
        SLOW[name](mesh)

    main = threading.main_thread().ident or 0

    def interrupt() -> None:
        while sys._current_frames()[main].f_code is not SLOW[name].__code__:
            time.sleep(0.01)
        signal.pthread_kill(main, signal.SIGINT)

    thread = threading.Thread(target=interrupt)
    thread.start()
    with pytest.raises(KeyboardInterrupt):
        compute()
    thread.join()


@pytest.mark.skipif(sys.platform == "win32", reason="signals of Unix")
@pytest.mark.parametrize("name", SLOW)
def test_ctrl_c_stops_what_would_take_minutes(name: str) -> None:
    """In a process of its own, which is ended where Ctrl-C does not."""
    program = f"import test_processes; test_processes.interrupt_what_would_take_minutes({name!r})"
    subprocess.run([sys.executable, "-c", program], cwd=Path(__file__).parent, check=True, timeout=60)


def resident() -> int:
    """Bytes in memory."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * 4096


def calls() -> List[Callable[[], object]]:
    mesh = grid(120, 120)
    wide = mesh.positions.astype(np.float64)
    tangents = darboux.generate_tangents(*mesh.arrays)

    def fail() -> None:
        with pytest.raises(ValueError):
            darboux.generate_tangents(*mesh.arrays, out=tangents[1:])

    return [
        lambda: darboux.generate_tangents(*mesh.arrays),
        lambda: darboux.generate_tangents(wide, *mesh.arrays[1:], full=True, return_report=True),
        lambda: darboux.generate_tangents(*mesh.arrays, out=tangents),
        lambda: darboux.split_vertices(mesh.indices, tangents, len(mesh.positions)),
        fail,
    ]


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")
@pytest.mark.parametrize("index", range(len(calls())))
def test_nothing_leaks(index: int) -> None:
    call = calls()[index]

    def repeat(times: int) -> int:
        for _ in range(times):
            call()
        gc.collect()
        return resident()

    repeat(10)
    before = repeat(10)
    # Most calls make more than a megabyte; 70 kilobytes per call that stay would show.
    assert repeat(150) - before < 10 << 20
