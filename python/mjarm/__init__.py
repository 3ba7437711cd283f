"""Robot arms on MuJoCo: kinematics, paths, plans, motions and control.

>>> import mjarm
>>> robot = mjarm.Robot("ur5e")
>>> robot.ik(mjarm.Pose([-0.13, 0.6, 0.1], euler=[3.14, 0, 1.57])).q
"""

from . import _library

_library.load()

from ._core import (  # noqa: E402 (the library comes first)
    CollisionReport,
    Contact,
    Curve,
    IkReason,
    IkSolution,
    JointLimits,
    Motion,
    Path,
    PathFix,
    PathReason,
    Plan,
    PlanReason,
    Pose,
    Robot,
    SingularKind,
    language,
    mujoco_version,
    set_language,
    shipped_models,
)
from .errors import BadInput, Error, Impossible, NoPath, NotAvailable, SystemFault, Unreachable, Usage  # noqa: E402

__all__ = [
    "BadInput",
    "CollisionReport",
    "Contact",
    "Curve",
    "Error",
    "IkReason",
    "IkSolution",
    "Impossible",
    "JointLimits",
    "Motion",
    "NoPath",
    "NotAvailable",
    "Path",
    "PathFix",
    "PathReason",
    "Plan",
    "PlanReason",
    "Pose",
    "Robot",
    "SingularKind",
    "SystemFault",
    "Unreachable",
    "Usage",
    "language",
    "mujoco_version",
    "set_language",
    "shipped_models",
]
