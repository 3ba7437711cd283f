"""python -m mjarm.data: episodes in other formats."""

from __future__ import annotations

import argparse
import signal
import sys
import time
from collections.abc import Callable
from typing import Any

from ..errors import BadInput, Error, Usage
from . import to_lerobot, to_mcap, to_robomimic
from ._words import say

INTERRUPTED = 130  # as shells have it for SIGINT

EXAMPLES = """
  mjarm record pick_place --out data --episodes 20
  python -m mjarm.data lerobot data --out data-lerobot
  python -m mjarm.data robomimic data --out data.hdf5 --action tool
  python -m mjarm.data mcap data more-data --out data-mcap
"""


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m mjarm.data", formatter_class=argparse.RawDescriptionHelpFormatter,
        description=say("Episodes of mjarm record in other formats.", "把 mjarm record 的回合转换为其他格式。"),
        epilog=say("Examples:", "示例：") + EXAMPLES)
    formats = parser.add_subparsers(dest="format", required=True, metavar="FORMAT")
    for name, what in (("lerobot", "LeRobotDataset v3.0"), ("robomimic", "HDF5 (robomimic)"), ("mcap", "MCAP (Foxglove, Rerun)")):
        one = formats.add_parser(name, help=what, description=what, epilog=say("Examples:", "示例：") + EXAMPLES,
                                 formatter_class=argparse.RawDescriptionHelpFormatter)
        one.add_argument("data", nargs="+", metavar="DATA", help=say("folder of mjarm record; several are parts of one set",
                                                                     "mjarm record 的文件夹；多个文件夹合为一个数据集"))
        one.add_argument("--out", required=True, help=say("file to write" if name == "robomimic" else "folder to write", "输出位置"))
        one.add_argument("--failed", action="store_true", help=say("those that did not succeed as well", "也包括未成功的回合"))
        one.add_argument("--force", action="store_true", help=say("replace what is there", "替换已有的输出"))
        if name != "mcap":
            one.add_argument("--action", choices=("joint", "tool"), default="joint",
                             help=say("joint references (default), or poses of the tool", "关节参考值（默认）或工具位姿"))
        if name == "lerobot":
            one.add_argument("--chinese", action="store_true", help=say("tasks in Chinese", "任务描述用中文"))
        if name == "robomimic":
            one.add_argument("--next-obs", action="store_true", help=say("observations of the next row as well", "也写下一行的观测"))
    return parser


def _shown() -> Callable[[int, int], None]:
    begin = time.monotonic()
    is_terminal = sys.stderr.isatty()

    def show(done: int, total: int) -> None:
        left = (time.monotonic() - begin) / done * (total - done)
        line = say(f"{done} of {total} episodes, {left:.0f} s left", f"{done}/{total} 个回合，还需 {left:.0f} s")
        if is_terminal:
            print(f"\r{line}\033[K", end="\n" if done == total else "", file=sys.stderr, flush=True)
        elif done == total or done % 100 == 0:
            print(line, file=sys.stderr, flush=True)

    return show


def main(words: list[str] | None = None) -> int:
    """The exit code: 0, 2 for what was asked wrongly, 1 for what failed."""
    options: dict[str, Any] = vars(_parser().parse_args(words))
    convert = {"lerobot": to_lerobot, "robomimic": to_robomimic, "mcap": to_mcap}[options.pop("format")]
    data, out = options.pop("data"), options.pop("out")
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # like Ctrl-C: nothing half written stays
    try:
        count = convert(data, out, progress=_shown(), **options)
    except (BadInput, Usage) as wrong:
        print(wrong, file=sys.stderr)
        return 2
    except Error as wrong:
        print(wrong, file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print(say(f"stopped; {out} was not written", f"已停止；未写出 {out}"), file=sys.stderr)
        return INTERRUPTED
    print(say(f"{out}: {count} episodes", f"{out}：{count} 个回合"))
    return 0


if __name__ == "__main__":
    sys.exit(main())
