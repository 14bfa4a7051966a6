"""Engines that process the files of a batch: local processes, Ray, Dask."""

import os
import subprocess
import sys
import threading
import warnings
from concurrent.futures import Future, ThreadPoolExecutor
from queue import SimpleQueue
from typing import Any, Callable, Dict, List, Optional, Protocol, Tuple, Union

from ._darboux import run_task

Ended = Tuple[int, Union[str, Exception]]
"""The number of a task, and its result or the error that prevented one."""


class LostWorker(Exception):
    """A worker ended before its task did."""


class Engine(Protocol):
    """Runs tasks. When the context ends, local workers and Ray's workers are stopped; Dask's workers finish their current
    tasks."""

    capacity: int
    """The number of tasks to start at the same time."""

    def start(self, number: int, task: str) -> None:
        """Start a task."""

    def wait(self) -> Ended:
        """Wait for the next task that ends."""
        ...

    def __enter__(self) -> "Engine": ...

    def __exit__(self, *_: object) -> None: ...


def run_task_on_one_thread(task: str) -> str:
    """What a cluster's workers run, on one processor each."""
    return run_task(task, 1)


WORKER = """
import sys
sys.path[:] = {path!r}
from darboux._worker import main
main({threads})
"""


class Local:
    """Local worker processes, each with a waiting thread in this process. A killed worker costs only its own file one try."""

    def __init__(self, workers: Optional[int]) -> None:
        processors = os.cpu_count() or 1
        self.capacity = workers or processors
        program = WORKER.format(path=sys.path, threads=max(1, processors // self.capacity))
        self.command = [sys.executable, "-X", "utf8", "-c", program]
        self.threads = ThreadPoolExecutor(self.capacity)
        self.ended: "SimpleQueue[Ended]" = SimpleQueue()
        self.own = threading.local()
        self.lock = threading.Lock()
        self.processes: List["subprocess.Popen[str]"] = []
        self.is_over = False

    def start(self, number: int, task: str) -> None:
        def end(future: "Future[str]") -> None:
            error = future.exception()
            self.ended.put((number, error if isinstance(error, Exception) else future.result()))

        self.threads.submit(self._run, task).add_done_callback(end)

    def wait(self) -> Ended:
        return self.ended.get()

    def _run(self, task: str) -> str:
        process: "subprocess.Popen[str]" = getattr(self.own, "process", None) or self._process()
        self.own.process = process
        assert process.stdin and process.stdout
        try:
            process.stdin.write(task + "\n")
            process.stdin.flush()
            result = process.stdout.readline()
        except OSError:
            result = ""
        if not result.endswith("\n"):
            self.own.process = None
            raise LostWorker(f"the process ended with code {process.wait()}")
        return result

    def _process(self) -> "subprocess.Popen[str]":
        with self.lock:
            if self.is_over:
                raise RuntimeError("the batch is over")
            process = subprocess.Popen(
                self.command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, encoding="utf-8"
            )
            self.processes.append(process)
        return process

    def __enter__(self) -> "Local":
        return self

    def __exit__(self, *_: object) -> None:
        with self.lock:
            self.is_over = True
            for process in self.processes:
                process.kill()
        self.threads.shutdown()
        for process in self.processes:
            process.wait()


class Ray:
    """The cluster that Ray is connected to, or that ray.init() finds or starts."""

    def __init__(self, workers: Optional[int]) -> None:
        import ray

        if not ray.is_initialized():
            ray.init()
        self.ray: Any = ray
        self.remote_function = ray.remote(max_retries=0)(run_task_on_one_thread)
        self.capacity = workers or 2 * int(ray.cluster_resources().get("CPU", 1))
        self.numbers: Dict[Any, int] = {}

    def start(self, number: int, task: str) -> None:
        self.numbers[self.remote_function.remote(task)] = number

    def wait(self) -> Ended:
        [task], _ = self.ray.wait(list(self.numbers), num_returns=1)
        number = self.numbers.pop(task)
        try:
            return number, self.ray.get(task)
        except self.ray.exceptions.RayTaskError as error:
            return number, error
        except self.ray.exceptions.RayError as error:
            return number, LostWorker(str(error))

    def __enter__(self) -> "Ray":
        return self

    def __exit__(self, *_: object) -> None:
        tasks = list(self.numbers)
        for task in tasks:
            self.ray.cancel(task, force=True)
        if tasks:
            self.ray.wait(tasks, num_returns=len(tasks), fetch_local=False)


PATIENCE = 60
"""Seconds that a batch that ends early waits for Dask's workers to finish."""


class Dask:
    """The cluster of the current distributed.Client."""

    def __init__(self, workers: Optional[int]) -> None:
        import distributed

        try:
            self.client: Any = distributed.get_client()
        except ValueError:
            raise ValueError("there is no Dask client; make one: distributed.Client(address)") from None
        self.first, self.killed, self.too_late = distributed.wait, distributed.KilledWorker, distributed.TimeoutError
        self.capacity = workers or 2 * max(1, sum(self.client.nthreads().values()))
        self.numbers: Dict[Any, int] = {}

    def start(self, number: int, task: str) -> None:
        self.numbers[self.client.submit(run_task_on_one_thread, task, pure=False)] = number

    def wait(self) -> Ended:
        done, _ = self.first(list(self.numbers), return_when="FIRST_COMPLETED")
        task = next(iter(done))
        number = self.numbers.pop(task)
        error = task.exception()
        if isinstance(error, self.killed):
            return number, LostWorker(str(error))
        return number, task.result() if error is None else error

    def __enter__(self) -> "Dask":
        return self

    def __exit__(self, *_: object) -> None:
        # Dask forgets tasks that it cancels, and lets them run on where nobody can wait for them: first they may end.
        tasks = list(self.numbers)
        if not tasks:
            return
        try:
            if self.client.nthreads():
                self.first(tasks, timeout=PATIENCE)
        except self.too_late:
            at_work = sum(not task.done() for task in tasks)
            warnings.warn(
                f"Dask's workers did not end {at_work} of the files in {PATIENCE} seconds: they may still write them; "
                "restart them, or wait, before these files are used",
                RuntimeWarning,
                stacklevel=2,
            )
        finally:
            self.client.cancel(tasks)


ENGINES: Dict[str, Callable[[Optional[int]], Engine]] = {"local": Local, "ray": Ray, "dask": Dask}
