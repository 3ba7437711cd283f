"""Entries of an episode's archive, which nobody vouches for: what is read is checked first and never larger than the file."""

from __future__ import annotations

import io
import os
import pathlib
import struct
import zipfile

import numpy as np

from ..errors import BadInput
from ._words import say

MAX_BYTES = 1 << 30  # of an archive, as in `mjarm replay`
MAX_DIRECTORY = 1 << 26  # of its central directory, which zipfile holds whole
MAX_NPY_HEADER = 1000
END = struct.Struct("<4s4H2LH")  # end of central directory record (APPNOTE 6.3.10, 4.3.16), without a comment


def fault(source: pathlib.Path, english: str, chinese: str) -> BadInput:
    """What is wrong with a file, as one line."""
    return BadInput(f"{source}: {say(english, chinese)}")


class Archive:
    """The entries of a zip archive that are stored as they are.

    Raises BadInput for what is no such archive.
    """

    def __init__(self, source: pathlib.Path) -> None:
        self.source = source
        try:
            self._check_end()
            self._zip = zipfile.ZipFile(source)
        except (zipfile.BadZipFile, NotImplementedError, ValueError) as bad:
            raise fault(source, "no zip archive of an episode", "不是回合的 zip 压缩包") from bad
        except OSError as bad:
            raise fault(source, f"cannot be read: {bad.strerror}", f"无法读取：{bad.strerror}") from bad
        entries = self._zip.infolist()
        self._entries = {entry.filename: entry for entry in entries}
        if len(self._entries) != len(entries) or any(
                entry.compress_type != zipfile.ZIP_STORED or entry.flag_bits & 1 or entry.file_size != entry.compress_size
                for entry in entries):
            self._zip.close()
            raise fault(source, "expected entries that are stored as they are, each once", "各条目应原样存储，且只出现一次")

    def _check_end(self) -> None:
        with self.source.open("rb") as file:
            size = file.seek(0, os.SEEK_END)
            if not END.size <= size <= MAX_BYTES:
                raise ValueError
            file.seek(size - END.size)
            signature, _, _, _, _, directory, offset, comment = END.unpack(file.read(END.size))
        if signature != b"PK\5\6" or comment or directory > MAX_DIRECTORY or offset + directory + END.size > size:
            raise ValueError

    def close(self) -> None:
        self._zip.close()

    def read(self, name: str, most: int = MAX_BYTES) -> bytes:
        """An entry of at most so many bytes, its checksum compared."""
        entry = self._entries.get(name)
        if entry is None or entry.file_size > most:
            raise fault(self.source, f'expected an entry "{name}" of at most {most} bytes', f'应有条目“{name}”，不超过 {most} 字节')
        try:
            return self._zip.read(entry)
        except (zipfile.BadZipFile, EOFError, ValueError, NotImplementedError, struct.error, OSError) as bad:
            raise fault(self.source, f'"{name}" is damaged', f"“{name}”已损坏") from bad

    def column(self, name: str, rows: int, width: int | None = None) -> np.ndarray:
        """`NAME.npy`: finite doubles, shape (rows, width); any width from 1 where none is given."""
        data = self.read(f"{name}.npy")
        file = io.BytesIO(data)
        try:
            if np.lib.format.read_magic(file) != (1, 0):
                raise ValueError
            shape, fortran, dtype = np.lib.format.read_array_header_1_0(file, max_header_size=MAX_NPY_HEADER)
        except (ValueError, TypeError, SyntaxError, RecursionError, MemoryError) as bad:
            raise fault(self.source, f'"{name}.npy" is no array of numpy', f"“{name}.npy”不是 numpy 数组") from bad
        fits = (not fortran and dtype == np.dtype("<f8") and len(shape) == 2 and shape[0] == rows and shape[1] >= 1
                and width in (None, shape[1]) and len(data) - file.tell() == 8 * shape[0] * shape[1])
        values = np.frombuffer(data, "<f8", offset=file.tell()).reshape(shape) if fits else np.array([[np.nan]])
        if not np.isfinite(values).all():
            wanted = f"({rows}, {'n' if width is None else width})"
            raise fault(self.source, f'"{name}.npy": expected finite doubles of shape {wanted}',
                        f"“{name}.npy”：应为形状 {wanted} 的有限双精度数")
        return values
