"""Episodes of `mjarm record` in the formats that others train on and look at.

>>> from mjarm.data import to_lerobot
>>> to_lerobot(["data"], "data-lerobot")

`python -m mjarm.data --help` does the same from a shell. Each format needs packages of its own: pip install 'mjarm[data]'.
"""

from .lerobot import to_lerobot
from .mcap import to_mcap
from .robomimic import to_robomimic

__all__ = ["to_lerobot", "to_mcap", "to_robomimic"]
