"""Lines for users, in their language."""

from __future__ import annotations

import importlib
from types import ModuleType

from .._core import language
from ..errors import NotAvailable


def say(english: str, chinese: str) -> str:
    """The one of the two that the user reads."""
    return chinese if language() == "zh" else english


def needed(module: str, package: str) -> ModuleType:
    """Imports what a format alone needs.

    Raises NotAvailable with the command that installs it.
    """
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as missing:
        raise NotAvailable(say(f"{package} is missing: pip install 'mjarm[data]', or pip install {package}",
                               f"缺少 {package}：pip install 'mjarm[data]'，或 pip install {package}")) from missing
