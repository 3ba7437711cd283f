"""Pictures as a video in MP4, the same bytes for the same pictures with one FFmpeg."""

from __future__ import annotations

import pathlib
from fractions import Fraction
from typing import Any

import numpy as np

from ._words import needed

CODEC = "libx264"  # its own name in FFmpeg is h264
GROUP = 2  # a whole picture every second one, as LeRobot has it: rows are read in any order
QUALITY = 18  # constant rate factor of x264


class Video:
    """Writes one video; every picture is shown for 1 / fps seconds."""

    def __init__(self, file: pathlib.Path, fps: int, size: int) -> None:
        av = needed("av", "av")
        self._file = file
        self._step = Fraction(1, fps)
        self._av = av
        self._container = av.open(str(file), "w", options={"fflags": "+bitexact"})
        # One thread and no B pictures: bytes do not depend on the machine, and the first picture is at time 0.
        stream = self._container.add_stream(CODEC, rate=fps, options={
            "g": str(GROUP), "crf": str(QUALITY), "bf": "0", "threads": "1", "flags": "+bitexact"})
        stream.width = stream.height = size
        # Halved colours take even sizes.
        stream.pix_fmt = "yuv420p" if size % 2 == 0 else "yuv444p"
        self._stream = stream
        self.pictures = 0

    def add(self, picture: np.ndarray) -> None:
        """Pixels: uint8 of shape (size, size, 3)."""
        frame = self._av.VideoFrame.from_ndarray(picture, format="rgb24")
        frame.pts = self.pictures
        frame.time_base = self._step
        self.pictures += 1
        self._container.mux(self._stream.encode(frame))

    def size_so_far(self) -> int:
        """[bytes] written, but for what the encoder holds back."""
        return self._file.stat().st_size

    def close(self) -> None:
        if self.pictures:
            self._container.mux(self._stream.encode(None))
        self._container.close()


def video_info(fps: int, size: int) -> dict[str, Any]:
    """What LeRobot keeps in `features[...]["info"]`."""
    return {"is_depth_map": False, "video.height": size, "video.width": size, "video.codec": "h264",
            "video.pix_fmt": "yuv420p" if size % 2 == 0 else "yuv444p", "video.fps": fps, "video.channels": 3,
            "video.g": GROUP, "video.crf": QUALITY, "video.preset": None, "video.fast_decode": 0,
            "video.video_backend": "pyav", "video.extra_options": {"bf": 0}, "has_audio": False}
