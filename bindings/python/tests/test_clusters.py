"""Batches on Ray and Dask, where they are installed: workers are killed while they work, and nothing is lost."""

import os
import signal
import time
from pathlib import Path
from typing import Callable, Iterator, List

import darboux
import pytest
from darboux import _engines
from test_batch import by_command, contents, library

PREFIX = "ray::run_task_on_one_thread"
"""How Ray names a process while it works on a file."""


@pytest.fixture
def ray() -> Iterator[None]:
    os.environ["RAY_AUTH_MODE"] = "disabled"
    module = pytest.importorskip("ray")
    module.init(num_cpus=2, include_dashboard=False, log_to_driver=False)
    yield
    module.shutdown()


@pytest.fixture
def dask() -> Iterator[None]:
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
    ) as cluster, distributed.Client(cluster):
        yield


def ray_workers() -> List[int]:
    found = []
    for command in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            if command.read_text().startswith(PREFIX):
                found.append(int(command.parent.name))
        except OSError:
            continue
    return found


def dask_workers() -> List[int]:
    import distributed

    return list(distributed.get_client().run(os.getpid).values())


def check(engine: str, workers: Callable[[], List[int]], folder: Path) -> None:
    models, out = library(folder, copies=12), folder / "out"
    killed: List[int] = []

    def kill(done: int, total: int) -> None:
        if not killed:
            killed.extend(workers())
            for worker in killed:
                os.kill(worker, signal.SIGKILL)

    report = darboux.batch(models, out, engine=engine, progress=kill)  # type: ignore[arg-type]
    assert killed
    assert report["totals"] == {"files": 15, "written": 13, "copied": 2, "up_to_date": 0, "failed": 0}
    assert contents(out) == by_command(models, folder / "expected")
    (models / "a.glb").write_bytes(b"glTF")
    again = darboux.batch(models, out, engine=engine, retries=1, progress=False)  # type: ignore[arg-type]
    assert (again["totals"]["up_to_date"], again["totals"]["failed"]) == (14, 1)
    assert again["files"][0]["tries"] == 2


def check_early_end(engine: str, folder: Path) -> None:
    """Nobody works on the files of a batch that has ended."""
    models, out = library(folder, copies=12), folder / "out"

    def stop(done: int, total: int) -> None:
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        darboux.batch(models, out, engine=engine, progress=stop)  # type: ignore[arg-type]
    before = contents(out)
    assert not [name for name in before if ".darboux-" in name]
    time.sleep(1)
    assert contents(out) == before
    assert darboux.batch(models, out, engine=engine, progress=False)["totals"]["failed"] == 0  # type: ignore[arg-type]
    assert contents(out) == by_command(models, folder / "expected")


def test_ray_ends_early(ray: None, tmp_path: Path) -> None:
    check_early_end("ray", tmp_path)


def test_dask_ends_early(dask: None, tmp_path: Path) -> None:
    check_early_end("dask", tmp_path)


def test_ray(ray: None, tmp_path: Path) -> None:
    check("ray", ray_workers, tmp_path)


def dying_beside_seven(roll: Path) -> Callable[[str], str]:
    """What a pool runs in which seven processes work, and each further one dies at its first file."""

    def run_task_on_one_thread(task: str) -> str:
        import fcntl
        import os

        from darboux._darboux import run_task

        if os.environ.get("HEALTHY") != str(os.getpid()):
            with open(roll, "a+") as file:
                fcntl.flock(file, fcntl.LOCK_EX)
                file.seek(0)
                is_healthy = file.read().count("works") < 7
                file.write("works\n" if is_healthy else "dies\n")
            if not is_healthy:
                os._exit(9)
            os.environ["HEALTHY"] = str(os.getpid())
        return run_task(task, 1)

    return run_task_on_one_thread


def test_one_of_eight_workers_always_dies(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    os.environ["RAY_AUTH_MODE"] = "disabled"
    module = pytest.importorskip("ray")
    module.init(num_cpus=8, include_dashboard=False, log_to_driver=False)
    try:
        models, out, roll = library(tmp_path, copies=200), tmp_path / "out", tmp_path / "roll"
        monkeypatch.setattr(_engines, "run_task_on_one_thread", dying_beside_seven(roll))
        report = darboux.batch(models, out, engine="ray", retries=5, progress=False)
    finally:
        module.shutdown()
    assert (report["totals"]["written"], report["totals"]["failed"]) == (201, 0)
    assert contents(out) == by_command(models, tmp_path / "expected")
    tries = sum(file["tries"] - 1 for file in report["files"])
    assert tries == roll.read_text().count("dies") > 0


def test_dask(dask: None, tmp_path: Path) -> None:
    check("dask", dask_workers, tmp_path)


def doze(seconds: str) -> None:
    time.sleep(float(seconds))


def test_dask_is_not_waited_for_without_end(monkeypatch: pytest.MonkeyPatch) -> None:
    distributed = pytest.importorskip("distributed")
    monkeypatch.setattr(_engines, "run_task_on_one_thread", doze)
    monkeypatch.setattr(_engines, "PATIENCE", 1)
    with distributed.LocalCluster(n_workers=1, processes=False, dashboard_address=None) as cluster, distributed.Client(cluster):
        with pytest.warns(RuntimeWarning, match="did not end 1 of the files in 1 seconds"):
            with _engines.Dask(None) as engine:
                engine.start(0, "5")


def test_dask_is_not_waited_for_without_workers() -> None:
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(n_workers=0, processes=False, dashboard_address=None) as cluster, distributed.Client(cluster):
        before = time.monotonic()
        with _engines.Dask(None) as engine:
            engine.start(0, "")
        assert time.monotonic() - before < _engines.PATIENCE / 2


def test_dask_needs_a_client(tmp_path: Path) -> None:
    pytest.importorskip("distributed")
    with pytest.raises(ValueError, match="there is no Dask client"):
        darboux.batch(library(tmp_path), tmp_path / "out", engine="dask")
