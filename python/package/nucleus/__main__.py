"""``python -m nucleus`` is the ``nucleus`` command."""

import signal
import sys

from ._nucleus import main as _main


def main() -> int:
    """Runs the command with the arguments of the process and returns its exit code."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        # The command has a handler of its own, and its exit code says that it was interrupted.
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _main(sys.argv[1:], [sys.executable, "-m", "nucleus"])


if __name__ == "__main__":
    sys.exit(main())
