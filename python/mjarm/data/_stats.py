"""Statistics of features with the names and shapes that LeRobot normalizes by. Quantiles are exact, linear between samples."""

from __future__ import annotations

import numpy as np

Stats = dict[str, np.ndarray]

QUANTILES = {"q01": 0.01, "q10": 0.10, "q50": 0.50, "q90": 0.90, "q99": 0.99}


def column_stats(values: np.ndarray) -> Stats:
    """Of values (n, k), n >= 1: each of shape (k,), `count` of shape (1,)."""
    values = values.astype(np.float64)
    out = {"min": values.min(0), "max": values.max(0), "mean": values.mean(0), "std": values.std(0),
           "count": np.array([len(values)])}
    for name, quantile in zip(QUANTILES, np.quantile(values, list(QUANTILES.values()), axis=0), strict=True):
        out[name] = quantile
    return out


class PictureStats:
    """Of pictures, in colours from 0 to 1; counts of the 256 values of each colour are all it keeps."""

    def __init__(self) -> None:
        self._counts = np.zeros((3, 256), np.int64)
        self._pictures = 0

    def add(self, picture: np.ndarray) -> None:
        """Pixels: uint8 of shape (height, width, 3)."""
        self._counts += np.stack([np.bincount(picture[:, :, i].ravel(), minlength=256) for i in range(3)])
        self._pictures += 1

    def merge(self, other: PictureStats) -> None:
        self._counts += other._counts
        self._pictures += other._pictures

    def stats(self) -> Stats:
        """Each of shape (3, 1, 1), `count` of shape (1,)."""
        levels, total = np.arange(256.0), self._counts[0].sum()
        mean = self._counts @ levels / total
        spread = (self._counts * (levels - mean[:, None]) ** 2).sum(1) / total
        out = {"min": (self._counts > 0).argmax(1), "max": 255 - (self._counts[:, ::-1] > 0).argmax(1), "mean": mean,
               "std": np.sqrt(spread)}
        out |= {name: self._quantile(share * (total - 1)) for name, share in QUANTILES.items()}
        shaped: Stats = {name: (value / 255).reshape(3, 1, 1) for name, value in out.items()}
        return shaped | {"count": np.array([self._pictures])}

    def _quantile(self, place: float) -> np.ndarray:
        """The value at a place from 0 in the order of all pixels, shape (3,)."""
        below = self._counts.cumsum(1)
        low, high = ((below <= at).sum(1) for at in (np.floor(place), np.ceil(place)))
        return low + (high - low) * (place - np.floor(place))
