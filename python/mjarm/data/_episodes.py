"""Folders of `mjarm record` as one set of episodes."""

from __future__ import annotations

import io
import pathlib
import struct
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from types import TracebackType

import numpy as np

from ..errors import BadInput
from ._archive import Archive, fault
from ._head import Head, read_head
from ._words import needed, say

PNG = struct.Struct(">8sI4s2I5B")  # signature and IHDR (ISO/IEC 15948, 5.2 and 11.2.2)
MAX_PNG = 1 << 24


class Episode:
    """One archive, open.

    Raises BadInput where it is not what `mjarm record` writes.
    """

    def __init__(self, file: pathlib.Path) -> None:
        self._archive = Archive(file)
        self.head = read_head(self._archive)

    def __enter__(self) -> Episode:
        return self

    def __exit__(self, kind: type[BaseException] | None, what: BaseException | None, where: TracebackType | None) -> None:
        self._archive.close()

    def column(self, name: str, width: int | None = None) -> np.ndarray:
        """Doubles of shape (rows, width)."""
        return self._archive.column(name, self.head.rows, width)

    def document(self) -> bytes:
        """`episode.json` as it stands there."""
        return self._archive.read("episode.json")

    def png(self, camera: str, row: int) -> bytes:
        """What a camera saw, as a PNG file of 8 bits a colour and of the size that the head tells."""
        name = f"frames/{camera}/{row:06d}.png"
        data = self._archive.read(name, MAX_PNG)
        size = self.head.size
        wanted = PNG.pack(b"\x89PNG\r\n\x1a\n", 13, b"IHDR", size, size, 8, 2, 0, 0, 0)
        if data[:PNG.size] != wanted:
            raise fault(self._archive.source, f'"{name}": expected an RGB picture of {size}x{size}', f"“{name}”：应为 {size}x{size} 的 RGB 图像")
        return data

    def picture(self, camera: str, row: int) -> np.ndarray:
        """Its pixels: uint8 of shape (size, size, 3)."""
        image, data = needed("PIL.Image", "pillow"), self.png(camera, row)
        try:
            return np.asarray(image.open(io.BytesIO(data), formats=["PNG"]).convert("RGB"))
        except (OSError, SyntaxError, ValueError) as bad:
            raise fault(self._archive.source, f'picture {row} of camera "{camera}" is damaged',
                        f"相机“{camera}”的第 {row} 幅图像已损坏") from bad

    def rewards(self) -> np.ndarray:
        """float32 of shape (rows,): 1 where the task is done, which is the last row of a success; else 0."""
        out = np.zeros(self.head.rows, np.float32)
        out[-1:] = self.head.success
        return out

    def dones(self) -> np.ndarray:
        """bool of shape (rows,): true in the last row."""
        out = np.zeros(self.head.rows, bool)
        out[-1:] = True
        return out


@dataclass(frozen=True)
class Entry:
    """Where an episode lies."""

    file: pathlib.Path
    seed: int
    number: int
    english: str


class EpisodeSet:
    """The episodes of one or more folders, by seed and number; one archive is open at a time.

    Parameters
    ----------
    folders : paths
        Made by `mjarm record` with the same options; seeds may differ, the same episode twice is refused.
    failed : bool
        Those that did not succeed as well, where they have rows.

    Raises BadInput with the file and what was expected there.
    """

    def __init__(self, folders: Sequence[pathlib.Path], failed: bool = False) -> None:
        self.head: Head
        found: dict[tuple[int, int], Entry] = {}
        for file in _files(folders, failed):
            with Episode(file) as episode:
                self._take(file, episode.head, found)
        if not found:
            raise BadInput(say(f"no episodes in {', '.join(map(str, folders))}: mjarm record makes them",
                               f"{'、'.join(map(str, folders))} 中没有回合：可用 mjarm record 生成"))
        self.entries = [found[key] for key in sorted(found)]

    def _take(self, file: pathlib.Path, head: Head, found: dict[tuple[int, int], Entry]) -> None:
        if not head.rows:
            return
        if not found:
            self.head = head
        elif head.kind != self.head.kind:
            raise fault(file, "another task, robot, size, rate or model than the episodes before", "任务、机器人、尺寸、帧率或模型与前面的回合不同")
        if double := found.get((head.seed, head.number)):
            raise fault(file, f"episode {head.number} of seed {head.seed} is in {double.file} as well",
                        f"种子 {head.seed} 的回合 {head.number} 也在 {double.file} 中")
        found[head.seed, head.number] = Entry(file, head.seed, head.number, head.english)

    def __len__(self) -> int:
        return len(self.entries)

    def __iter__(self) -> Iterator[Episode]:
        for entry in self.entries:
            with Episode(entry.file) as episode:
                head = episode.head
                if not head.rows or (head.kind, head.seed, head.number) != (self.head.kind, entry.seed, entry.number):
                    raise fault(entry.file, "was changed meanwhile", "其间已被更改")
                yield episode


def _files(folders: Sequence[pathlib.Path], failed: bool) -> Iterator[pathlib.Path]:
    for folder in folders:
        if not folder.is_dir():
            raise BadInput(say(f"{folder}: no such folder", f"{folder}：没有此文件夹"))
        yield from sorted(folder.glob("episode_*.zip"))
        if failed:
            yield from sorted((folder / "failed").glob("episode_*.zip"))
