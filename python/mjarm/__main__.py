"""The program `mjarm`, as `python -m mjarm` and as the command that the package installs."""

import signal
import sys

from ._core import run_program


def main() -> int:
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # the program catches it itself, where it should
    return run_program(sys.argv[1:])


if __name__ == "__main__":
    sys.exit(main())
