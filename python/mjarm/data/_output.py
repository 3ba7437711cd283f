"""What is written is whole or not there: it gets its name when it is complete."""

from __future__ import annotations

import contextlib
import os
import pathlib
import shutil
from collections.abc import Callable, Generator

from ..errors import SystemFault, Usage
from ._words import say


def _remove(path: pathlib.Path) -> None:
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path)
    else:
        path.unlink(missing_ok=True)


@contextlib.contextmanager
def whole(out: pathlib.Path, force: bool, is_alike: Callable[[pathlib.Path], bool]) -> Generator[pathlib.Path]:
    """A name beside `out` to write a file or folder to, which takes the place of `out` in the end; where anything goes
    wrong, Ctrl-C included, it is removed and `out` is as it was.

    Raises Usage where `out` is there and `force` is not set, or it is not `is_alike`: nothing else is ever removed.
    """
    if os.path.lexists(out) and not force:
        raise Usage(say(f"{out} exists: another --out, or --force to replace it", f"{out} 已存在：请换一个 --out，或用 --force 替换"))
    if os.path.lexists(out) and not is_alike(out):
        raise Usage(say(f"{out} is something else, which is not replaced", f"{out} 是别的内容，不会被替换"))
    out = pathlib.Path(os.path.abspath(out))
    part = out.with_name(f".{out.name}.{os.getpid()}.part")
    try:
        out.parent.mkdir(parents=True, exist_ok=True)
        _remove(part)
        yield part
        if os.path.lexists(out):
            old = part.with_suffix(".old")
            out.rename(old)
            part.rename(out)
            _remove(old)
        else:
            part.rename(out)
    except OSError as bad:
        raise SystemFault(f"{bad.filename or out}: {bad.strerror or bad}") from bad
    finally:
        with contextlib.suppress(OSError):
            _remove(part)
