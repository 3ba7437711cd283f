"""Progress of long calls below the cell of a notebook."""

from __future__ import annotations

import sys

_WIDTH = 100  # columns that are overwritten


def show(line: str) -> None:
    """One line in the place of the last one; an empty one takes it away."""
    sys.stderr.write("\r" + line.ljust(_WIDTH) + ("" if line else "\r"))
    sys.stderr.flush()
