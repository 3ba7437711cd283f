"""HDF5 in the layout of robomimic: `data/demo_0/obs/...`, `actions`, `rewards`, `dones`, `states`, and masks (its page "Dataset Overview")."""

from __future__ import annotations

import json
import os
import pathlib
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ._episodes import Episode, EpisodeSet
from ._output import whole
from ._words import needed

GYM = 2  # robomimic's EnvType.GYM_TYPE
VALID = 10  # every tenth episode is for validation


def _observations(episode: Episode) -> dict[str, np.ndarray]:
    head = episode.head
    dof = len(head.joints)
    return {"joint_position": episode.column("joint_position", dof), "joint_velocity": episode.column("joint_velocity", dof),
            "tool_pose": episode.column("tool_pose", 7), "gripper": episode.column("gripper", 1),
            "object": episode.column("object_poses", 7 * len(head.objects))}


def _next(values: np.ndarray) -> np.ndarray:
    """Of the next row; of the last row its own."""
    return np.concatenate([values[1:], values[-1:]])


def _write_pictures(groups: list[Any], episode: Episode, camera: str) -> None:
    """Into each group, one picture at a time: the second one is a row ahead."""
    head = episode.head
    shape = (head.rows, head.size, head.size, 3)
    sets = [group.create_dataset(f"{camera}_image", shape, np.uint8, chunks=(1, *shape[1:]), compression="gzip", compression_opts=4)
            for group in groups]
    for row in range(head.rows):
        picture = episode.picture(camera, row)
        sets[0][row] = picture
        for ahead in sets[1:]:
            if row:
                ahead[row - 1] = picture
            if row == head.rows - 1:
                ahead[row] = picture


def _write(demo: Any, episode: Episode, action: str, next_obs: bool) -> None:
    head = episode.head
    width = len(head.joints) + 1 if action == "joint" else 8
    demo.attrs["num_samples"] = head.rows
    demo.attrs["ep_meta"] = json.dumps({"lang": head.english, "seed": head.seed, "number": head.number, "success": head.success})
    demo["actions"] = episode.column(f"action_{action}", width)
    demo["rewards"] = episode.rewards().astype(np.float64)
    demo["dones"] = episode.dones().astype(np.int64)
    demo["states"] = np.hstack([episode.column("time", 1), episode.column("qpos"), episode.column("qvel")])
    groups = [demo.create_group("obs"), *([demo.create_group("next_obs")] if next_obs else [])]
    for name, values in _observations(episode).items():
        for group, ahead in zip(groups, (values, _next(values)), strict=False):
            group[name] = ahead
    for camera in head.cameras:
        _write_pictures(groups, episode, camera.name)


def _write_masks(file: Any, count: int) -> None:
    names = np.array([f"demo_{i}".encode() for i in range(count)])
    valid = np.arange(count) % VALID == VALID - 1
    file["mask/train"], file["mask/valid"] = names[~valid], names[valid]


def to_robomimic(folders: Sequence[str | os.PathLike[str]], out: str | os.PathLike[str], *, action: str = "joint", failed: bool = False,
                 next_obs: bool = False, force: bool = False, progress: Callable[[int, int], object] | None = None) -> int:
    """Writes one HDF5 file in the layout of robomimic.

    Returns the number of episodes. Raises BadInput for what is no episode of this set, Usage for an `out` that exists, and
    NotAvailable where `h5py` or `pillow` is missing.

    Parameters
    ----------
    folders : paths
        Made by `mjarm record`, parts of one set.
    out : path
        Of the file; it appears when it is complete.
    action : "joint" or "tool"
        [rad] joint references, or [m, 1] the pose of the tool as x y z qw qx qy qz; of the next row, then the gripper's command.
    failed : bool
        Those that did not succeed as well, where they have rows.
    next_obs : bool
        Observations of the next row as well, which learning from rewards needs; the file is twice as large.
    force : bool
        Replaces a file that is there.
    progress : callable or None
        Called with the number of episodes done and of all.
    """
    h5py = needed("h5py", "h5py")
    needed("PIL", "pillow")
    with whole(pathlib.Path(out), force, h5py.is_hdf5) as part:
        episodes = EpisodeSet([pathlib.Path(folder) for folder in folders], failed)
        head, total = episodes.head, 0
        with h5py.File(part, "w") as file:
            data = file.create_group("data")
            for i, episode in enumerate(episodes):
                _write(data.create_group(f"demo_{i}"), episode, action, next_obs)
                total += episode.head.rows
                if progress:
                    progress(i + 1, len(episodes))
            data.attrs["total"] = total
            data.attrs["env_args"] = json.dumps({"env_name": "mjarm/Task-v0", "type": GYM, "env_kwargs": {
                "task": head.task, "robot": head.robot, "size": head.size, "fps": head.fps, "action": action}})
            _write_masks(file, len(episodes))
        return len(episodes)
