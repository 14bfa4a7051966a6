"""Batches on this machine: what comes out, what is done again, and what a kill leaves."""

import os
import shutil
import signal
import subprocess
import sys
import threading
from pathlib import Path
from typing import Dict, List, Tuple

import darboux
import pytest
from conftest import ROOT
from darboux._batch import _reason
from darboux._engines import LostWorker

ASSETS = ROOT / "assets"
MODEL = ASSETS / "NormalTangentTest/NormalTangentTest.glb"
JOURNAL, REPORT = "darboux-journal.jsonl", "darboux-report.json"


def library(folder: Path, copies: int = 0) -> Path:
    """Models in a folder: three, one of them of several files, and copies of a larger one."""
    models = folder / "models"
    models.mkdir()
    shutil.copy(ASSETS / "made/quantised-sparse.glb", models / "a.glb")
    shutil.copy(ASSETS / "Fox/Fox.glb", models / "b.glb")
    shutil.copytree(ASSETS / "TwoSidedPlane", models / "plane")
    for number in range(copies):
        shutil.copy(MODEL, models / f"copy{number}.glb")
    return models


def contents(out: Path) -> Dict[str, bytes]:
    """Every file, hidden ones too, but for the batch's own."""
    files = (path for path in out.rglob("*") if path.is_file() and path.name not in (JOURNAL, REPORT))
    return {str(path.relative_to(out)): path.read_bytes() for path in files}


def by_command(models: Path, out: Path) -> Dict[str, bytes]:
    """What the command makes of the models."""
    command = [sys.executable, "-m", "darboux", "tangents", str(models), "--out-dir", str(out), "-q"]
    subprocess.run(command, check=True)
    return contents(out)


def test_a_batch_is_the_command_on_many_files(tmp_path: Path) -> None:
    models, out = library(tmp_path), tmp_path / "out"
    steps: List[Tuple[int, int]] = []
    report = darboux.batch(models, out, workers=2, progress=lambda *step: steps.append(step))
    assert contents(out) == by_command(models, tmp_path / "expected")
    assert report["totals"] == {"files": 3, "written": 1, "copied": 2, "up_to_date": 0, "failed": 0}
    assert [file["tries"] for file in report["files"]] == [1] * 3
    assert steps == [(1, 3), (2, 3), (3, 3)]
    assert (out / REPORT).read_text().count('"outcome": "written"') == 1

    again = darboux.batch([models / "a.glb", models / "b.glb"], out, progress=False)
    assert again["totals"]["up_to_date"] == 2
    assert again["files"][0]["primitives"] == report["files"][0]["primitives"]
    small = darboux.batch(models, out, encoding="snorm8x4", overwrite=True, only_needed=None, strict=False, progress=False)
    assert (small["totals"]["written"], small["totals"]["up_to_date"]) == (2, 0)
    assert contents(out) != contents(tmp_path / "expected")


def test_the_command_goes_on_with_a_batch(tmp_path: Path) -> None:
    models, out = library(tmp_path), tmp_path / "out"
    darboux.batch(models, out, threshold=180, normals="keep", progress=False)
    command = [sys.executable, "-m", "darboux", "tangents", str(models), "--out-dir", str(out), "--resume"]
    ran = subprocess.run(command, check=True, stderr=subprocess.PIPE, text=True)
    assert ran.stderr.count(": up to date") == 3


def test_failures_are_collected(tmp_path: Path) -> None:
    models, out = library(tmp_path), tmp_path / "out"
    (models / "aa.glb").write_bytes(MODEL.read_bytes()[:5000])
    (tmp_path / "empty").mkdir()
    report = darboux.batch([models, tmp_path / "empty", tmp_path / "nothing.glb"], out, retries=1, progress=False)
    failed = {Path(file["input"]).name: file for file in report["files"] if file["status"] == "failed"}
    assert sorted(failed) == ["aa.glb", "empty", "nothing.glb"]
    assert failed["aa.glb"]["tries"] == failed["nothing.glb"]["tries"] == 2
    assert "the folder contains no model" in failed["empty"]["error"]
    assert report["totals"]["written"] + report["totals"]["copied"] == 3
    shutil.copy(MODEL, models / "aa.glb")
    assert darboux.batch(models, out, progress=False)["totals"] == {
        "files": 4,
        "written": 1,
        "copied": 0,
        "up_to_date": 3,
        "failed": 0,
    }


def test_bad_batches(tmp_path: Path) -> None:
    models, out = library(tmp_path), tmp_path / "out"
    with pytest.raises(ValueError, match="engine is 'spark'; it must be one of 'local', 'ray', 'dask'"):
        darboux.batch(models, out, engine="spark")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="retries must be 0 or more"):
        darboux.batch(models, out, retries=-1)
    with pytest.raises(ValueError, match="in_place is not an option of a batch; the options are allow_outside, "):
        darboux.batch(models, out, in_place=True)
    with pytest.raises(FileNotFoundError, match="no such folder or file") as missing:
        darboux.batch([models, tmp_path / "modles"], out)
    assert missing.value.filename == str(tmp_path / "modles")
    with pytest.raises(ValueError, match="invalid value 'best' for '--method <NAME>'") as caught:
        darboux.batch(models, out, method="best")
    assert "\n" not in str(caught.value)
    with pytest.raises(ValueError, match="a.glb would be replaced by its own output"):
        darboux.batch(models / "a.glb", models)
    assert not out.exists()
    out.mkdir()
    (out / "file").write_text("")
    with pytest.raises(ValueError, match="is not a folder"):
        darboux.batch(models, out / "file")


def test_one_batch_at_a_time(tmp_path: Path) -> None:
    models, out = library(tmp_path), tmp_path / "out"
    refused: List[str] = []

    def begin_another(done: int, total: int) -> None:
        with pytest.raises(ValueError, match="another run is writing there") as caught:
            darboux.batch(models, out, progress=False)
        refused.append(str(caught.value))

    report = darboux.batch(models, out, workers=2, progress=begin_another)
    assert len(refused) == 3
    assert report["totals"]["failed"] == 0
    assert contents(out) == by_command(models, tmp_path / "expected")


def test_temporary_files_of_running_programs_stay_and_abandoned_ones_are_removed(tmp_path: Path) -> None:
    fcntl = pytest.importorskip("fcntl")
    models, out = library(tmp_path), tmp_path / "out"
    out.mkdir()
    for name in (".darboux-abc123", ".darboux-0123456789abcdef-abc124", ".darboux-notes"):
        (out / name).write_text("half a file")
    with open(out / ".darboux-abc123", "rb") as running:
        fcntl.flock(running, fcntl.LOCK_EX)
        darboux.batch(models, out, progress=False)
        darboux.batch(models, out, progress=False)
    assert sorted(path.name for path in out.glob(".darboux-*")) == [".darboux-abc123", ".darboux-notes"]


def test_outputs_that_were_changed_are_made_again(tmp_path: Path) -> None:
    models, out = library(tmp_path), tmp_path / "out"
    darboux.batch(models, out, progress=False)
    whole = (out / "a.glb").read_bytes()
    (out / "a.glb").write_bytes(whole[:-1] + bytes([whole[-1] ^ 1]))
    assert darboux.batch(models, out, progress=False)["totals"]["up_to_date"] == 2
    assert (out / "a.glb").read_bytes() == whole


def records(out: Path) -> int:
    """The number of finished outputs in a journal. Other lines say what runs planned and began."""
    return sum('"content"' in line for line in (out / JOURNAL).read_text().splitlines())


def test_an_error_of_the_callback_ends_the_batch_and_loses_nothing(tmp_path: Path) -> None:
    models, out = library(tmp_path, copies=4), tmp_path / "out"

    def stop(done: int, total: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt) as kept:
        darboux.batch(models, out, workers=2, progress=stop)
    assert records(out) == 1
    # The traceback is still there, the batch's hold on the folder is not.
    assert kept.traceback
    report = darboux.batch(models, out, progress=False)
    assert (report["totals"]["up_to_date"], report["totals"]["failed"]) == (1, 0)
    assert contents(out) == by_command(models, tmp_path / "expected")


def state_and_parent(process: int) -> Tuple[str, int]:
    """One letter, and the process that started it; Z for what is gone."""
    try:
        state, parent = Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[:2]
    except OSError:
        return "Z", 0
    return state, int(parent)


def children() -> List[int]:
    """Processes that this one started."""
    processes = [int(path.name) for path in Path("/proc").glob("[0-9]*")]
    found = ((process, *state_and_parent(process)) for process in processes)
    return [process for process, state, parent in found if parent == os.getpid() and state != "Z"]


def kill_while_writing(out: Path, over: threading.Event, killed: List[int]) -> None:
    """Kill all workers at a moment when one of them has half a file."""
    while not over.is_set() and not killed:
        if not list(out.rglob(".darboux-*")):
            continue
        workers = children()
        for worker in workers:
            os.kill(worker, signal.SIGSTOP)
        while any(state_and_parent(worker)[0] not in "TZ" for worker in workers):
            pass
        # Now nothing moves: is it still half a file?
        is_half = bool(list(out.rglob(".darboux-*")))
        for worker in workers:
            os.kill(worker, signal.SIGKILL if is_half else signal.SIGCONT)
        killed += workers if is_half else []


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")
def test_workers_killed_half_way_lose_nothing(tmp_path: Path) -> None:
    models = library(tmp_path, copies=20)
    expected = by_command(models, tmp_path / "expected")
    killed: List[int] = []
    for attempt in range(20):
        out, over = tmp_path / f"out{attempt}", threading.Event()
        killer = threading.Thread(target=kill_while_writing, args=(out, over, killed))
        killer.start()
        report = darboux.batch(models, out, workers=2, progress=False)
        over.set()
        killer.join()
        assert report["totals"]["failed"] == 0
        assert contents(out) == expected
        if killed:
            break
    assert killed
    assert max(file["tries"] for file in report["files"]) == 2
    assert darboux.batch(models, out, progress=False)["totals"]["up_to_date"] == 23


def test_a_file_that_kills_its_worker_is_reported_as_failed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    models, out = library(tmp_path), tmp_path / "out"
    monkeypatch.setattr(
        "darboux._engines.WORKER",
        "import os, sys\nif 'b.glb' in sys.stdin.readline(): os._exit(9)\nprint(end='', flush=True)\nos._exit(3)",
    )
    report = darboux.batch([models / "b.glb"], out, retries=1, progress=False)
    [file] = report["files"]
    assert (file["status"], file["tries"]) == ("failed", 2)
    assert file["error"].endswith("b.glb: its worker was lost: the process ended with code 9")


def test_an_error_is_not_a_lost_worker() -> None:
    remote = ValueError("ray::run_task()\n  File x\nValueError: burnt\n")
    assert _reason(remote) == "its worker raised an error: ValueError: burnt"
    assert _reason(LostWorker("killed\nby whom")) == "its worker was lost: killed"
    assert _reason(OSError()) == "its worker raised an error: OSError"


DRIVER = """
import sys, darboux
darboux.batch(sys.argv[1], sys.argv[2], workers=2, progress=False)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="signals of Unix")
def test_a_killed_batch_goes_on(tmp_path: Path) -> None:
    models, out = library(tmp_path, copies=20), tmp_path / "out"
    with subprocess.Popen([sys.executable, "-c", DRIVER, str(models), str(out)]) as driver:
        journal = out / JOURNAL
        while True:
            # Before the journal: a machine that pauses here must not make it seem that nothing was journalled.
            has_ended = driver.poll() is not None
            if journal.exists() and records(out):
                break
            assert not has_ended
        driver.kill()
    report = darboux.batch(models, out, workers=2, progress=False)
    assert report["totals"]["up_to_date"] > 0
    assert report["totals"]["failed"] == 0
    assert contents(out) == by_command(models, tmp_path / "expected")
