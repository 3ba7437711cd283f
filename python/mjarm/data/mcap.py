"""MCAP with the schemas of Foxglove: one file an episode, which Foxglove and Rerun show as they are."""

from __future__ import annotations

import os
import pathlib
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ._episodes import Episode, EpisodeSet
from ._head import CameraHead
from ._output import whole
from ._words import needed

SCHEMAS = "foxglove_schemas_protobuf"
WORLD = "world"


def _message(name: str) -> Any:
    return getattr(needed(f"{SCHEMAS}.{name}_pb2", "foxglove-schemas-protobuf"), name)


def _set_time(stamp: Any, at: int) -> Any:
    stamp.seconds, stamp.nanos = divmod(at, 1_000_000_000)


def _camera_quaternion(camera: CameraHead) -> tuple[float, ...]:
    """Of a frame that looks along z with y down, as pictures have it, where MuJoCo looks along -z with y up."""
    w, x, y, z = camera.quaternion
    return -x, w, z, -y  # times (0, 1, 0, 0), half a turn about x


class _Writer:
    """The messages of one episode, in the order of time."""

    def __init__(self, writer: Any, episode: Episode) -> None:
        self._writer, self._episode, self._head = writer, episode, episode.head
        dof = len(self._head.joints)
        self._position, self._velocity = (episode.column(name, dof) for name in ("joint_position", "joint_velocity"))
        self._action = episode.column("action_joint", dof + 1)
        self._gripper = episode.column("gripper", 1)
        self._tool, self._objects = episode.column("tool_pose", 7), episode.column("object_poses", 7 * len(self._head.objects))
        self._motion = episode.column("motion", 1)[:, 0].astype(int)
        self._rewards = episode.rewards()

    def write(self) -> None:
        times = [round(float(time) * 1e9) for time in self._episode.column("time", 1)[:, 0]]
        self._log(times[0], self._head.english, "task")
        for camera in self._head.cameras:
            self._calibration(times[0], camera)
        words: dict[int, str] = dict(enumerate(self._head.motions))
        for row, at in enumerate(times):
            if row == 0 or self._motion[row] != self._motion[row - 1]:
                self._log(at, words.get(int(self._motion[row]), ""), "motion")
            self._row(row, at)
        self._log(times[-1], "success" if self._head.success else self._head.reason or "failed", "outcome")

    def _send(self, topic: str, message: Any, at: int) -> None:
        self._writer.write_message(topic, message, log_time=at, publish_time=at)

    def _row(self, row: int, at: int) -> None:
        head = self._head
        poses = [("tool", self._tool[row])]
        poses += [(name, self._objects[row, 7 * i:7 * i + 7]) for i, name in enumerate(head.objects)]
        poses += [(camera.name, np.array([*camera.position, *_camera_quaternion(camera)])) for camera in head.cameras]
        self._transforms(at, poses)
        names = [*head.joints, "gripper"]
        self._joints("/joint_states", at, names, [*self._position[row], *self._gripper[row]], [*self._velocity[row]])
        self._joints("/action", at, names, [*self._action[row]], [])
        for camera in head.cameras:
            image = _message("CompressedImage")(frame_id=camera.name, format="png", data=self._episode.png(camera.name, row))
            _set_time(image.timestamp, at)
            self._send(f"/{camera.name}/image", image, at)

    def _transforms(self, at: int, poses: list[tuple[str, np.ndarray]]) -> None:
        message = _message("FrameTransforms")()
        for name, pose in poses:
            one = message.transforms.add(parent_frame_id=WORLD, child_frame_id=name)
            _set_time(one.timestamp, at)
            p, q = one.translation, one.rotation
            p.x, p.y, p.z, q.w, q.x, q.y, q.z = map(float, pose)
        self._send("/tf", message, at)

    def _joints(self, topic: str, at: int, names: list[str], positions: list[float], velocities: list[float]) -> None:
        message = _message("JointStates")()
        _set_time(message.timestamp, at)
        for i, (name, position) in enumerate(zip(names, positions, strict=True)):
            message.joints.add(name=name, position=position, **({"velocity": velocities[i]} if i < len(velocities) else {}))
        self._send(topic, message, at)

    def _calibration(self, at: int, camera: CameraHead) -> None:
        (fx, fy), (cx, cy) = camera.focal, camera.center
        message = _message("CameraCalibration")(
            frame_id=camera.name, width=camera.size, height=camera.size, K=[fx, 0, cx, 0, fy, cy, 0, 0, 1],
            R=np.eye(3).ravel(), P=[fx, 0, cx, 0, 0, fy, cy, 0, 0, 0, 1, 0])
        _set_time(message.timestamp, at)
        self._send(f"/{camera.name}/calibration", message, at)

    def _log(self, at: int, text: str, name: str) -> None:
        kind = _message("Log")
        message = kind(level=kind.Level.Value("INFO"), message=text, name=name)
        _set_time(message.timestamp, at)
        self._send("/log", message, at)


def _is_alike(there: pathlib.Path) -> bool:
    return there.is_dir() and all(file.suffix == ".mcap" for file in there.iterdir())


def to_mcap(folders: Sequence[str | os.PathLike[str]], out: str | os.PathLike[str], *, failed: bool = False, force: bool = False,
            progress: Callable[[int, int], object] | None = None) -> int:
    """Writes a folder of MCAP files, `episode_SEED_NUMBER.mcap`.

    Topics: `/tf` (tool, objects and cameras in the world), `/joint_states`, `/action`, `/CAMERA/image`, `/CAMERA/calibration`,
    `/log` (the task, each motion, the outcome). Times are those of the simulation. `episode.json` is attached.

    Returns the number of episodes. Raises BadInput for what is no episode of this set, Usage for an `out` that exists, and
    NotAvailable where `mcap`, `mcap-protobuf-support` or `foxglove-schemas-protobuf` is missing.

    Parameters
    ----------
    folders : paths
        Made by `mjarm record`, parts of one set.
    out : path
        Of the folder; it appears when it is complete.
    failed : bool
        Those that did not succeed as well, where they have rows.
    force : bool
        Replaces a folder of such files that is there.
    progress : callable or None
        Called with the number of episodes done and of all.
    """
    needed("mcap", "mcap")
    writer_of = needed("mcap_protobuf.writer", "mcap-protobuf-support").Writer
    _message("Log")
    with whole(pathlib.Path(out), force, _is_alike) as part:
        episodes = EpisodeSet([pathlib.Path(folder) for folder in folders], failed)
        part.mkdir()
        for i, episode in enumerate(episodes):
            head = episode.head
            with (part / f"episode_{head.seed}_{head.number:06d}.mcap").open("wb") as file, writer_of(file) as writer:
                _Writer(writer, episode).write()
                writer.add_attachment(0, 0, "episode.json", "application/json", episode.document())
            if progress:
                progress(i + 1, len(episodes))
        return len(episodes)
