"""A worker process of a local batch: reads one task per line, writes one result per line, and ends with its input."""

import signal
import sys

from ._darboux import run_task


def main(threads: int) -> None:
    """Run tasks with this number of threads each."""
    # Ctrl-C goes to every process of the terminal; the batch's own process handles it.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    for task in sys.stdin:
        sys.stdout.write(run_task(task, threads) + "\n")
        sys.stdout.flush()
