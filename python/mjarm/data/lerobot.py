"""LeRobotDataset v3.0: rows in Parquet, pictures in MP4, what they mean in JSON.

Layout and names are those of lerobot 0.6 (its page "LeRobotDataset v3.0"); `pyarrow`, `av` and `pillow` write it, `lerobot` is not needed.
"""

from __future__ import annotations

import json
import os
import pathlib
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ._episodes import Episode, EpisodeSet
from ._output import whole
from ._stats import PictureStats, Stats, column_stats
from ._video import Video, video_info
from ._words import needed

VERSION = "v3.0"
CHUNK = 1000  # files of a folder
DATA_MB = 100
VIDEO_MB = 200
DATA_PATH = "data/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet"
VIDEO_PATH = "videos/{video_key}/chunk-{chunk_index:03d}/file-{file_index:03d}.mp4"
BATCH = 100  # episodes whose statistics are held in memory
EPISODES_PATH = "meta/episodes/chunk-000/file-000.parquet"
POSE = ("x", "y", "z", "qw", "qx", "qy", "qz")
Progress = Callable[[int, int], object]
"""Called with the number of episodes done and of all."""


def _numbers(names: Sequence[str]) -> dict[str, Any]:
    return {"dtype": "float32", "shape": [len(names)], "names": list(names)}


def features(episodes: EpisodeSet, action: str) -> dict[str, dict[str, Any]]:
    """`features` of info.json, in the order of the columns."""
    head = episodes.head
    picture = {"dtype": "video", "shape": [head.size, head.size, 3], "names": ["height", "width", "channels"],
               "info": video_info(head.fps, head.size)}
    one: dict[str, Any] = {"shape": [1], "names": None}
    joints = [*head.joints, "gripper"]
    return {
        "observation.state": _numbers(joints),
        "observation.environment_state": _numbers([f"{name}_{part}" for name in head.objects for part in POSE]),
        **{f"observation.images.{camera.name}": picture for camera in head.cameras},
        "action": _numbers(joints if action == "joint" else [*(f"tool_{part}" for part in POSE), "gripper"]),
        "next.reward": {"dtype": "float32", **one}, "next.done": {"dtype": "bool", **one}, "next.success": {"dtype": "bool", **one},
        "timestamp": {"dtype": "float32", **one}, "frame_index": {"dtype": "int64", **one},
        "episode_index": {"dtype": "int64", **one}, "index": {"dtype": "int64", **one}, "task_index": {"dtype": "int64", **one},
    }


class _Files:
    """Numbers of files: the next one where one would grow beyond its size."""

    def __init__(self, most: int) -> None:
        self._most, self._number, self._episodes = most, 0, 0

    def place(self, size: int) -> tuple[int, int]:
        """Chunk and file of the next episode, where the file of the last one has `size` bytes."""
        if self._episodes and size * (1 + 1 / self._episodes) >= self._most:
            self._number, self._episodes = self._number + 1, 0
        self._episodes += 1
        return divmod(self._number, CHUNK)


class _Videos:
    """The videos of one camera, one after another."""

    def __init__(self, root: pathlib.Path, key: str, fps: int, size: int) -> None:
        self._root, self._key, self._fps, self._size = root, key, fps, size
        self._files = _Files(VIDEO_MB << 20)
        self._place: tuple[int, int] | None = None
        self._video: Video | None = None
        self.total = PictureStats()

    def add(self, episode: Episode, camera: str) -> tuple[dict[str, Any], Stats]:
        """Where the episode's pictures are, and their statistics."""
        place = self._files.place(self._video.size_so_far() if self._video else 0)
        if self._video is None or place != self._place:
            self.close()
            file = self._root / VIDEO_PATH.format(video_key=self._key, chunk_index=place[0], file_index=place[1])
            file.parent.mkdir(parents=True, exist_ok=True)
            self._place, self._video = place, Video(file, self._fps, self._size)
        first, seen = self._video.pictures, PictureStats()
        for row in range(episode.head.rows):
            picture = episode.picture(camera, row)
            seen.add(picture)
            self._video.add(picture)
        self.total.merge(seen)
        where = {"chunk_index": place[0], "file_index": place[1], "from_timestamp": first / self._fps,
                 "to_timestamp": self._video.pictures / self._fps}
        return {f"videos/{self._key}/{name}": value for name, value in where.items()}, seen.stats()

    def close(self) -> None:
        if self._video:
            self._video.close()
        self._video = None


class _Writer:
    """One data set, episode after episode."""

    def __init__(self, root: pathlib.Path, episodes: EpisodeSet, action: str, chinese: bool) -> None:
        self._pa, self._pq = needed("pyarrow", "pyarrow"), needed("pyarrow.parquet", "pyarrow")
        head = episodes.head
        self._root, self._action, self._chinese, self._head = root, action, chinese, head
        self._features = features(episodes, action)
        self._tables = {key: one for key, one in self._features.items() if one["dtype"] != "video"}
        self._schema = self._pa.schema([(key, self._type(one)) for key, one in self._tables.items()])
        self._videos = {camera.name: _Videos(root, f"observation.images.{camera.name}", head.fps, head.size)
                        for camera in head.cameras}
        self._files, self._data_files = _Files(DATA_MB << 20), list[pathlib.Path]()
        self._rows_writer: Any = None
        self._episodes_writer: Any = None
        self._tasks: dict[str, int] = {}
        self._episodes: list[dict[str, Any]] = []  # those that are not written yet
        self._origin: list[dict[str, Any]] = []
        self._frames = 0

    def _type(self, feature: dict[str, Any]) -> Any:
        kind = {"float32": self._pa.float32(), "int64": self._pa.int64(), "bool": self._pa.bool_()}[feature["dtype"]]
        return kind if feature["names"] is None else self._pa.list_(kind, feature["shape"][0])

    def add(self, episode: Episode) -> None:
        head, index, first = episode.head, len(self._origin), self._frames
        task = head.chinese if self._chinese else head.english
        values = self._values(episode, self._tasks.setdefault(task, len(self._tasks)))
        chunk, file = self._write_rows(values)
        row: dict[str, Any] = {"episode_index": index, "tasks": [task], "length": head.rows, "data/chunk_index": chunk,
                               "data/file_index": file, "dataset_from_index": first, "dataset_to_index": first + head.rows}
        stats = {key: column_stats(one.reshape(head.rows, -1)) for key, one in values.items()}
        for camera, videos in self._videos.items():
            where, stats[f"observation.images.{camera}"] = videos.add(episode, camera)
            row |= where
        row |= {f"stats/{key}/{name}": value.tolist() for key in self._features for name, value in stats[key].items()}
        self._episodes.append(row | {"meta/episodes/chunk_index": 0, "meta/episodes/file_index": 0})
        if len(self._episodes) >= BATCH:
            self._write_episodes()
        self._origin.append({"seed": head.seed, "number": head.number, "success": head.success})
        self._frames += head.rows

    def _values(self, episode: Episode, task: int) -> dict[str, np.ndarray]:
        head = episode.head
        dof, rows = len(head.joints), np.arange(head.rows)
        numbers = {
            "observation.state": np.hstack([episode.column("joint_position", dof), episode.column("gripper", 1)]),
            "observation.environment_state": episode.column("object_poses", 7 * len(head.objects)),
            "action": episode.column(f"action_{self._action}", dof + 1 if self._action == "joint" else 8),
            "next.reward": episode.rewards(), "next.done": episode.dones(), "next.success": episode.rewards() > 0,
            "timestamp": rows / head.fps, "frame_index": rows, "episode_index": np.full(head.rows, len(self._origin)),
            "index": self._frames + rows, "task_index": np.full(head.rows, task),
        }
        return {key: numbers[key].astype(one["dtype"]) for key, one in self._tables.items()}

    def _write_rows(self, values: dict[str, np.ndarray]) -> tuple[int, int]:
        """One group of rows an episode, which readers find at once."""
        place = self._files.place(os.path.getsize(self._data_files[-1]) if self._data_files else 0)
        file = self._root / DATA_PATH.format(chunk_index=place[0], file_index=place[1])
        if self._rows_writer is None or file != self._data_files[-1]:
            self._close_rows()
            file.parent.mkdir(parents=True, exist_ok=True)
            self._rows_writer = self._pq.ParquetWriter(file, self._schema, compression="snappy")
            self._data_files.append(file)
        columns = [self._pa.FixedSizeListArray.from_arrays(self._pa.array(one.ravel()), one.shape[1])
                   if self._features[key]["names"] else self._pa.array(one) for key, one in values.items()]
        self._rows_writer.write_table(self._pa.Table.from_arrays(columns, schema=self._schema))
        return place

    def _write_episodes(self) -> None:
        file = self._root / EPISODES_PATH
        if self._episodes_writer is None:
            file.parent.mkdir(parents=True)
            schema = self._pa.Table.from_pylist(self._episodes).schema
            self._episodes_writer = self._pq.ParquetWriter(file, schema, compression="snappy")
        self._episodes_writer.write_table(self._pa.Table.from_pylist(self._episodes, self._episodes_writer.schema))
        self._episodes.clear()

    def _close_rows(self) -> None:
        if self._rows_writer is not None:
            self._rows_writer.close()

    def close(self) -> None:
        self._close_rows()
        if self._episodes_writer is not None:
            self._episodes_writer.close()
        for videos in self._videos.values():
            videos.close()

    def finish(self) -> None:
        if self._episodes:
            self._write_episodes()
        self.close()
        self._write_tasks()
        stats = {key: self._stats_of(key) for key in self._features}
        self._write_json("stats", {key: {name: value.tolist() for name, value in one.items()} for key, one in stats.items()})
        head, total = self._head, len(self._origin)
        self._write_json("info", {
            "codebase_version": VERSION, "fps": head.fps, "features": self._features, "total_episodes": total,
            "total_frames": self._frames, "total_tasks": len(self._tasks), "chunks_size": CHUNK,
            "data_files_size_in_mb": DATA_MB, "video_files_size_in_mb": VIDEO_MB, "data_path": DATA_PATH,
            "video_path": VIDEO_PATH, "robot_type": head.robot, "splits": {"train": f"0:{total}"}})
        self._write_json("mjarm", {"task": head.task, "robot": head.robot, "action": self._action,
                                   "model_hash": head.model_hash, "episodes": self._origin})

    def _stats_of(self, key: str) -> Stats:
        """Of all rows, which are read again, one feature at a time: quantiles do not add up."""
        if camera := key.removeprefix("observation.images.") if self._features[key]["dtype"] == "video" else None:
            return self._videos[camera].total.stats()
        parts = [self._pq.read_table(file, columns=[key]).column(0).combine_chunks() for file in self._data_files]
        if self._features[key]["names"]:
            parts = [part.flatten() for part in parts]
        values = np.concatenate([part.to_numpy(zero_copy_only=False) for part in parts])
        return column_stats(values.reshape(self._frames, -1))

    def _write_tasks(self) -> None:
        """A frame of pandas whose index is the task, as LeRobot reads it."""
        table = self._pa.table({"task_index": self._pa.array(self._tasks.values(), self._pa.int64()),
                                "task": self._pa.array(self._tasks.keys(), self._pa.string())})
        kinds = {"task_index": ("int64", "int64"), "task": ("unicode", "object")}
        about = {"index_columns": ["task"], "pandas_version": "2.0.0", "column_indexes": [], "columns": [
            {"name": name, "field_name": name, "pandas_type": kind, "numpy_type": stored, "metadata": None}
            for name, (kind, stored) in kinds.items()]}
        self._pq.write_table(table.replace_schema_metadata({"pandas": json.dumps(about)}), self._root / "meta/tasks.parquet")

    def _write_json(self, name: str, document: dict[str, Any]) -> None:
        text = json.dumps(document, indent=4, ensure_ascii=False)
        (self._root / "meta" / f"{name}.json").write_text(text, encoding="utf-8")


def to_lerobot(folders: Sequence[str | os.PathLike[str]], out: str | os.PathLike[str], *, action: str = "joint", failed: bool = False,
               chinese: bool = False, force: bool = False, progress: Progress | None = None) -> int:
    """Writes a LeRobotDataset v3.0.

    Returns the number of episodes. Raises BadInput for what is no episode of this set, Usage for an `out` that exists, and
    NotAvailable where `pyarrow`, `av` or `pillow` is missing.

    Parameters
    ----------
    folders : paths
        Made by `mjarm record`, parts of one set.
    out : path
        Of the data set; it appears when it is complete.
    action : "joint" or "tool"
        [rad] joint references, or [m, 1] the pose of the tool as x y z qw qx qy qz; of the next row, then the gripper's command.
    failed : bool
        Those that did not succeed as well, where they have rows.
    chinese : bool
        Tasks in Chinese.
    force : bool
        Replaces a data set that is there.
    progress : callable or None
        Called with the number of episodes done and of all.
    """
    for module, package in (("pyarrow", "pyarrow"), ("av", "av"), ("PIL", "pillow")):
        needed(module, package)
    with whole(pathlib.Path(out), force, lambda there: (there / "meta" / "mjarm.json").is_file()) as part:
        episodes = EpisodeSet([pathlib.Path(folder) for folder in folders], failed)
        writer = _Writer(part, episodes, action, chinese)
        try:
            for i, episode in enumerate(episodes):
                writer.add(episode)
                if progress:
                    progress(i + 1, len(episodes))
            writer.finish()
        finally:
            writer.close()
        return len(episodes)
