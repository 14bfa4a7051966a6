"""Batches: adds tangents to many files with worker processes, Ray or Dask, and collects the report."""

import errno
import json
import os
from pathlib import Path
from typing import Any, Callable, Dict, Iterator, List, Literal, Optional, Sequence, Union

from ._darboux import MODEL_ENDINGS, DistributedBatch, DistributedJob, __version__, failed_task
from ._engines import ENGINES, Engine, LostWorker
from ._process import PathLike

REPORT = "darboux-report.json"

MODEL_EXTENSIONS = tuple(MODEL_ENDINGS.split(", "))

OPTIONS = (
    "allow_outside",
    "apply_texture_transform",
    "encoding",
    "memory_limit",
    "method",
    "mode",
    "normals",
    "only_needed",
    "overwrite",
    "strict",
    "threshold",
)


def batch(
    files: Union[PathLike, Sequence[PathLike]],
    out: PathLike,
    *,
    engine: Literal["local", "ray", "dask"] = "local",
    workers: Optional[int] = None,
    retries: int = 2,
    progress: Union[bool, Callable[[int, int], object]] = True,
    **options: Any,
) -> Dict[str, Any]:
    """Add tangents to many models, as `darboux tangents FILES --out-dir OUT --resume` does, in many processes.

    A batch that was stopped continues when it is called again: outputs made from the same content with the same options are kept,
    others are replaced. Outputs are complete or absent, even if a process is killed. A file that fails is reported, and the others go on.

    Parameters
    ----------
    files : path-like or sequence of path-like
        Models, and folders that are searched for models; paths below folders are kept. A model that cannot be read is reported as failed.
    out : path-like
        The folder of outputs, of the journal, darboux-journal.jsonl, and of the report, darboux-report.json. One batch at a time.
    engine : str
        'local': processes of this machine. 'ray', 'dask': the cluster that Ray or Dask is connected to; its machines must have darboux and
        see the same files at the same paths.
    workers : int, optional
        Files that are worked on at the same time; by default as many as there are processors.
    retries : int
        How often a file that failed, or whose worker was lost, is tried again.
    progress : bool or callable
        True: a bar on a terminal, where tqdm is installed. A callable is given the files done and their total, after each.
    **options
        Of the command: method, mode, threshold, normals ('flat', 'smooth', 'crease=30'), encoding, overwrite, only_needed, strict,
        apply_texture_transform, allow_outside, memory_limit.

    Returns
    -------
    dict
        The report of `darboux tangents --json`, with the 'tries' of each file.

    Raises
    ------
    ValueError
        An option is unknown or has a wrong value; two files would have the same output; another batch writes there.
    FileNotFoundError
        A path that is not named like a model does not exist.
    OSError
        The folder cannot be written.
    """
    _check(engine, workers, retries)
    out = Path(os.path.abspath(out))
    inputs = [files] if isinstance(files, (str, os.PathLike)) else list(files)
    paths = [os.path.abspath(path) for path in inputs]
    _refuse_missing_folders(paths)
    tasks = DistributedBatch(paths, out, list(_arguments(options)))
    try:
        with ENGINES[engine](workers) as running:
            done = _run_all(tasks, running, retries, progress)
        report = _report([json.loads(report) for report in tasks.failed] + done)
        # While the folder is locked: the next batch writes its own.
        _write(out / REPORT, report)
    finally:
        tasks.close()
    return report


def bake_job(
    job: PathLike,
    *,
    engine: Literal["local", "ray", "dask"] = "local",
    workers: Optional[int] = None,
    retries: int = 2,
    progress: Union[bool, Callable[[int, int], object]] = True,
    options: Sequence[str] = (),
) -> Dict[str, Any]:
    """Bake the entries of a job, as `darboux bake JOB --resume` does, in many processes.

    Parameters
    ----------
    job : path-like
        The TOML file; or a folder, with '--suffixes' in `options`. Its folder gets the journal, darboux-journal.jsonl. One run at a time.
    engine, workers, retries, progress
        As for batch. Each of the local workers has its share of the processors, each of a cluster's one processor.
    options : sequence of str
        Of the command, such as ['--suffixes', '--map', 'normal,ao'].

    Returns
    -------
    dict
        'bakes': for each entry its 'input', the low model, 'output', 'status' ('written', 'up_to_date' or 'failed'), 'error', 'tries', and 'bake', the
        report of `darboux bake --json`; and 'totals' by status.

    Raises
    ------
    ValueError
        The command refuses the job or an option; another run works on it.
    ImportError
        The engine's package is not installed.
    """
    _check(engine, workers, retries)
    tasks = DistributedJob(os.path.abspath(job), list(options))
    try:
        with ENGINES[engine](workers) as running:
            done = _run_all(tasks, running, retries, progress)
    finally:
        tasks.close()
    statuses = [entry["status"] for entry in done]
    totals = {status: statuses.count(status) for status in ("written", "up_to_date", "failed")}
    return {"command": "bake", "version": __version__, "bakes": done, "totals": {"bakes": len(done), **totals}}


def _check(engine: str, workers: Optional[int], retries: int) -> None:
    if engine not in ENGINES:
        raise ValueError(f"engine is {engine!r}; it must be one of {', '.join(map(repr, ENGINES))}")
    if retries < 0 or (workers is not None and workers < 1):
        raise ValueError("retries must be 0 or more, workers 1 or more")


def _refuse_missing_folders(paths: Sequence[str]) -> None:
    for path in paths:
        if not path.lower().endswith(MODEL_EXTENSIONS) and not os.path.exists(path):
            raise FileNotFoundError(errno.ENOENT, "there is no such folder or file; check the path", path)


def _arguments(options: Dict[str, Any]) -> Iterator[str]:
    for name, value in options.items():
        if name not in OPTIONS:
            raise ValueError(f"{name} is not an option of a batch; the options are {', '.join(OPTIONS)}")
        flag = "--" + name.replace("_", "-")
        if value is True:
            yield flag
        elif value is not None and value is not False:
            yield f"{flag}={value}"


def _run_all(
    batch: Union[DistributedBatch, DistributedJob],
    engine: Engine, retries: int, progress: Union[bool, Callable[[int, int], object]]
) -> List[Dict[str, Any]]:
    """The reports of all files, in the order of the inputs."""
    tasks = batch.tasks
    reports: List[Dict[str, Any]] = [{} for _ in tasks]
    tries = [0] * len(tasks)
    waiting = list(reversed(range(len(tasks))))
    running = 0
    with _ProgressBar(len(tasks), progress) as bar:
        while waiting or running:
            while waiting and running < engine.capacity:
                number = waiting.pop()
                tries[number] += 1
                engine.start(number, tasks[number])
                running += 1
            number, result = engine.wait()
            running -= 1
            if isinstance(result, Exception):
                result = failed_task(tasks[number], _reason(result))
            report = json.loads(result)["report"]
            if report["status"] == "failed" and tries[number] <= retries:
                # Behind all others: what prevented it may be over by then.
                waiting.insert(0, number)
                continue
            batch.record(result)
            reports[number] = {**report, "tries": tries[number]}
            bar.step()
    return reports


def _reason(error: Exception) -> str:
    """Reduces an error to one sentence: the last line of a traceback from a cluster, or the first line about a lost worker."""
    lines = [line.strip() for line in str(error).splitlines() if line.strip()] or [type(error).__name__]
    return f"its worker was lost: {lines[0]}" if isinstance(error, LostWorker) else f"its worker raised an error: {lines[-1]}"


def _report(files: List[Dict[str, Any]]) -> Dict[str, Any]:
    statuses = [file["status"] for file in files]
    totals = {"files": len(files)}
    totals.update({status: statuses.count(status) for status in ("written", "copied", "up_to_date", "failed")})
    return {"command": "tangents", "version": __version__, "files": files, "totals": totals}


def _write(path: Path, report: Dict[str, Any]) -> None:
    """Writes a file completely or not at all."""
    unfinished = path.with_name(f".darboux-{path.name}")
    unfinished.write_text(json.dumps(report, indent=2) + "\n", encoding="utf-8")
    os.replace(unfinished, path)


class _ProgressBar:
    """Reports how many files are done."""

    def __init__(self, total: int, progress: Union[bool, Callable[[int, int], object]]) -> None:
        self.done, self.total = 0, total
        self.tell = progress if callable(progress) else None
        self.bar: Any = None
        if progress is True:
            try:
                from tqdm import tqdm
            except ImportError:
                return
            # On a terminal only.
            self.bar = tqdm(total=total, unit="file", disable=None)

    def step(self) -> None:
        self.done += 1
        if self.tell:
            self.tell(self.done, self.total)
        if self.bar is not None:
            self.bar.update()

    def __enter__(self) -> "_ProgressBar":
        return self

    def __exit__(self, *_: object) -> None:
        if self.bar is not None:
            self.bar.close()
