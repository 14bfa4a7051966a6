"""A process of a local batch: an order per line comes in, an answer per line goes out. It ends with its input."""

import signal
import sys

from ._darboux import carry_out


def main(threads: int) -> None:
    """Carry out orders with so many threads each."""
    # A person's Ctrl-C is the batch's to take.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    for order in sys.stdin:
        sys.stdout.write(carry_out(order, threads) + "\n")
        sys.stdout.flush()
