"""Loads the libraries that the package does not have in its own names: MuJoCo's, of the package mujoco-core, which
`import mujoco` uses too, and those of X11."""

from __future__ import annotations

import ctypes
import importlib.util
import pathlib


def load() -> None:
    """Makes its functions known to the process, without importing `mujoco`."""
    spec = importlib.util.find_spec("mujoco")
    folders = list(spec.submodule_search_locations or ()) if spec else []
    found = [file for folder in folders for file in sorted(pathlib.Path(folder).glob("libmujoco.so.*"))]
    if not found:
        raise ImportError("mjarm needs the library of MuJoCo 4.0 (需要 MuJoCo 4.0 的库): pip install 'mujoco-core>=4.0,<4.1'")
    suitable = [file for file in found if file.name.startswith("libmujoco.so.4.0.")]
    if not suitable:
        raise ImportError(f"mjarm needs MuJoCo 4.0, but {found[0]} is installed (需要 MuJoCo 4.0，但装的是别的版本): "
                          "pip install 'mujoco-core>=4.0,<4.1'")
    ctypes.CDLL(str(suitable[0]), mode=ctypes.RTLD_GLOBAL)
    load_display()


def load_display() -> None:
    """Loads the libraries of X11: those of the system, as its OpenGL does, else copies that come with the package."""
    spare = pathlib.Path(__file__).with_name("spare")
    for name in ("libX11.so.6", "libXext.so.6", "libXrender.so.1"):
        try:
            ctypes.CDLL(name)
        except OSError:
            ctypes.CDLL(str(spare / name))
