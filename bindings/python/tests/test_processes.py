"""Threads, forked processes and memory."""

import gc
import multiprocessing
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Callable, List

import darboux
import numpy as np
import pytest
from conftest import Mesh, grid


def large() -> Mesh:
    """Large enough for more than one thread."""
    return grid(200, 150)


def test_results_outlive_inputs() -> None:
    mesh = large()
    tangents = darboux.generate_tangents(*mesh.arrays)
    before = tangents.copy()
    del mesh
    gc.collect()
    assert np.array_equal(tangents, before)


def test_other_threads_run_meanwhile() -> None:
    """The GIL is released: a thread counts on while another computes."""
    mesh = grid(700, 700)
    counts: List[int] = []
    done = threading.Event()

    def count() -> None:
        while not done.is_set():
            counts.append(1)
            time.sleep(0.0005)

    counter = threading.Thread(target=count)
    counter.start()
    before = len(counts)
    darboux.generate_tangents(*mesh.arrays, threads=1, full=True)
    during = len(counts) - before
    done.set()
    counter.join()
    assert during > 20


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


def hash_of_tangents(_: int) -> int:
    return hash(darboux.generate_tangents(*large().arrays).tobytes().hex())


@pytest.mark.skipif(sys.platform == "win32", reason="no fork")
@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")
def test_forked_processes_work() -> None:
    """A child has none of its parent's threads; it must not wait for them."""
    expected = hash_of_tangents(0)
    with multiprocessing.get_context("fork").Pool(2) as pool:
        assert pool.map_async(hash_of_tangents, range(4)).get(timeout=60) == [expected] * 4


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


def interrupt_what_would_take_minutes() -> None:
    mesh = fan(400_000)

    def compute() -> None:
        darboux.generate_tangents(*mesh.arrays, threshold=1)

    main = threading.main_thread().ident or 0

    def interrupt() -> None:
        while sys._current_frames()[main].f_code is not compute.__code__:
            time.sleep(0.01)
        signal.pthread_kill(main, signal.SIGINT)

    thread = threading.Thread(target=interrupt)
    thread.start()
    with pytest.raises(KeyboardInterrupt):
        compute()
    thread.join()


@pytest.mark.skipif(sys.platform == "win32", reason="signals of Unix")
def test_ctrl_c_stops_what_would_take_minutes() -> None:
    """In a process of its own, which is ended where Ctrl-C does not."""
    program = "import test_processes; test_processes.interrupt_what_would_take_minutes()"
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
