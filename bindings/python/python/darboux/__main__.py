"""`python -m darboux`: the command line."""

import signal
import sys

from ._darboux import run


def main() -> int:
    """Run the command with the process's arguments; return its exit code."""
    # The command has its own handler of Ctrl-C, which sets itself up only where there is none. Where Ctrl-C is ignored, as in the
    # background of a shell, that stays.
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    return run(["darboux", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
