"""The exceptions of mjarm. Each says in one line what was wrong and what was expected."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ._core import IkReason, IkSolution, PlanReason


class Error(Exception):
    """Anything that mjarm could not do."""


class BadInput(Error, ValueError):
    """A file or value is malformed, missing or of the wrong shape."""


class Usage(Error, ValueError):
    """The call itself makes no sense: an unknown name, options that contradict each other."""


class Impossible(Error):
    """Well-formed, but it cannot be done: a limit is broken, a check failed."""


class SystemFault(Error, OSError):
    """The operating system refused: a full disk, no permission, no display."""


class NotAvailable(Error):
    """Something optional is missing on this machine."""


class Unreachable(Impossible):
    """No joint values put the tool to the pose."""

    reason: IkReason
    """Why."""
    amount: float
    """How far beyond the bound: [m] of reach, [rad or m] of a joint."""
    joint: int | None
    """Which joint, where the reason is about one."""
    best: IkSolution
    """The nearest that was had; not an answer."""


class NoPath(Impossible):
    """No plan from start to goal."""

    reason: PlanReason
    """Why."""
    samples: int
    """Configurations that were drawn."""


class NoPick(Impossible):
    """An object cannot be picked up, or not put down."""

    reason: str
    """Word, such as "too_wide" or "grasp_out_of_reach"."""
    dropped: list[str]
    """What was wrong with each grasp that was looked at, a line each."""
