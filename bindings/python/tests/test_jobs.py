"""Jobs of bakes: what comes out, what is done again, and what a kill leaves."""

import subprocess
import sys
import time
from pathlib import Path
from typing import Dict

import darboux
import pytest
from conftest import ROOT

MODEL = ROOT / "assets/NormalTangentTest/NormalTangentTest.glb"

ENTRY = """
[[bake]]
low = "{model}"
high = "{model}"
output = "map{number}.png"
size = {size}
"""


def job(folder: Path, entries: int, size: int = 32) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    texts = [ENTRY.format(model=MODEL.as_posix(), number=number, size=size + number) for number in range(entries)]
    path = folder / "job.toml"
    path.write_text('[defaults]\nmap = ["normal", "ao"]\nao-rays = 4\n' + "".join(texts))
    return path


def maps(folder: Path) -> Dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.suffix == ".png"}


def by_command(folder: Path, entries: int, size: int = 32) -> Dict[str, bytes]:
    command = [sys.executable, "-m", "darboux", "bake", str(job(folder, entries, size)), "--quiet"]
    subprocess.run(command, check=True)
    return maps(folder)


def test_a_job_is_the_command_in_processes(tmp_path: Path) -> None:
    path = job(tmp_path / "out", 3)
    report = darboux.bake_job(path, workers=2, progress=False)
    assert report["totals"] == {"bakes": 3, "written": 3, "up_to_date": 0, "failed": 0}
    assert [entry["bake"]["size"][0] for entry in report["bakes"]] == [32, 33, 34]
    assert maps(path.parent) == by_command(tmp_path / "expected", 3)
    (path.parent / "map1.ao.png").unlink()
    again = darboux.bake_job(path, workers=2, progress=False)
    assert [entry["status"] for entry in again["bakes"]] == ["up_to_date", "written", "up_to_date"]
    # The command knows what the processes have done.
    command = [sys.executable, "-m", "darboux", "bake", str(path), "--resume"]
    assert "3 were up to date" in subprocess.run(command, capture_output=True, text=True, check=True).stderr


def test_an_entry_that_fails_does_not_stop_the_others(tmp_path: Path) -> None:
    path = job(tmp_path, 2)
    path.write_text(path.read_text().replace(MODEL.as_posix(), "missing.glb", 1))
    report = darboux.bake_job(path, workers=2, retries=1, progress=False)
    failed, written = report["bakes"]
    assert (failed["status"], failed["tries"], written["status"]) == ("failed", 2, "written")
    assert "missing.glb" in failed["error"]


def test_bad_jobs(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="engine is 'local2'"):
        darboux.bake_job(tmp_path, engine="local2")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="add --suffixes"):
        darboux.bake_job(tmp_path)
    with pytest.raises(ValueError, match="belongs to jobs"):
        darboux.bake_job(MODEL)
    with pytest.raises(ValueError, match="unexpected argument '--colour'"):
        darboux.bake_job(tmp_path, options=["--colour"])


PROGRAM = "import darboux, sys; darboux.bake_job(sys.argv[1], workers=2, progress=False)"


def test_a_killed_job_is_continued(tmp_path: Path) -> None:
    path = job(tmp_path / "out", 5, 160)
    process = subprocess.Popen([sys.executable, "-c", PROGRAM, str(path)])
    for _ in range(1200):
        if len(maps(path.parent)) >= 2:
            break
        time.sleep(0.05)
    process.kill()
    process.wait()
    time.sleep(0.5)
    darboux.bake_job(path, workers=2, progress=False)
    assert maps(path.parent) == by_command(tmp_path / "expected", 5, 160)
    unfinished = [file.name for file in path.parent.iterdir() if file.name.startswith(".")]
    assert unfinished == []
