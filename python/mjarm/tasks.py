"""The tasks of `mjarm record` as environments of gymnasium: what learns from its episodes acts in the same scenes.

>>> import gymnasium, mjarm.tasks
>>> env = gymnasium.make("mjarm/Task-v0", task="pick_place", robot="panda", size=128, fps=10, action="joint")
>>> seen, info = env.reset(seed=3)

Observations: `agent_pos` (joints [rad] and the gripper's command), `environment_state` (x y z qw qx qy qz of each object) and `pixels`
("front", "side"), with the shapes that a data set of `mjarm.data` has. Actions: `joint` (joints [rad] at the next row, the gripper from 0 open
to 1 closed) or `tool` (x y z qw qx qy qz of the tool there, the gripper). The reward is 1 where the task is done, which ends the episode.
"""

from __future__ import annotations

from typing import Any

try:
    import gymnasium
except ModuleNotFoundError as missing:
    from .errors import NotAvailable

    raise NotAvailable("mjarm.tasks needs gymnasium (需要 gymnasium): pip install gymnasium") from missing
import numpy as np

from ._core import Pose, Robot, TaskWorld, Tracker, language
from .errors import BadInput

ID = "mjarm/Task-v0"
ENTRY = "mjarm.tasks:TaskEnv"
SECONDS = 20  # after which an episode is cut off
TRACKED = 20  # steps of differential inverse kinematics from row to row
NUMBERS = 1_000_000_000  # scenes of a seed

Seen = dict[str, Any]


def _check(name: str, value: object, known: tuple[object, ...]) -> None:
    if value not in known:
        words = ", ".join(map(str, known))
        raise BadInput(f"{name}：应为 {words} 之一，而不是 {value!r}" if language() == "zh"
                       else f"{name}: expected one of {words}, not {value!r}")


class TaskEnv(gymnasium.Env[Seen, np.ndarray]):
    """One arm with a task; `task_description` tells it in words.

    Parameters
    ----------
    task : "reach" or "pick_place"
    robot : "panda" or "ur5e"
    size : int
        [px] of the square pictures.
    fps : int
        [1/s] actions and rows.
    action : "joint" or "tool"
    scenes : int
        Seed of the scenes, as `mjarm record --seed`, whose own is 1: another one has scenes that were not recorded.
    render_mode : None or "rgb_array"
        What the front camera sees.
    """

    metadata = {"render_modes": ["rgb_array"]}

    def __init__(self, task: str = "pick_place", robot: str = "panda", size: int = 128, fps: int = 10, action: str = "joint",
                 scenes: int = 0, render_mode: str | None = None) -> None:
        _check("action", action, ("joint", "tool"))
        _check("render_mode", render_mode, (None, "rgb_array"))
        self._world = TaskWorld(task=task, robot=robot, seed=scenes, size=size, fps=fps)
        self._tracker = None
        if action == "tool":
            scene = Robot(Robot(robot).file.with_name("pick.xml"))
            self._tracker = scene.tracker(dt=1 / fps / TRACKED, gain=1)
        self.metadata = self.metadata | {"render_fps": fps}
        self.render_mode = render_mode
        self.task = task
        state, objects = len(self._world.joint_names) + 1, 7 * len(self._world.object_names)
        every = gymnasium.spaces.Box(-np.inf, np.inf, (state,), np.float32)
        picture = gymnasium.spaces.Box(0, 255, (size, size, 3), np.uint8)
        seen: dict[str, gymnasium.Space[Any]] = {
            "agent_pos": every,
            "environment_state": gymnasium.spaces.Box(-np.inf, np.inf, (objects,), np.float32),
            "pixels": gymnasium.spaces.Dict({name: picture for name in self._world.cameras}),
        }
        self.observation_space = gymnasium.spaces.Dict(seen)
        self.action_space = every if action == "joint" else gymnasium.spaces.Box(-np.inf, np.inf, (8,), np.float32)

    @property
    def task_description(self) -> str:
        """What is asked for in this scene, in English."""
        return self._world.english

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Seen, dict[str, Any]]:
        """Begins a scene: one that the seed draws, or with `options={"number": n}` that of episode n."""
        super().reset(seed=seed)
        number = (options or {}).get("number")
        self._world.reset(int(self.np_random.integers(NUMBERS)) if number is None else number)
        return self._seen(), self._info()

    def step(self, action: np.ndarray) -> tuple[Seen, float, bool, bool, dict[str, Any]]:
        self._world.step(action if self._tracker is None else self._joints(self._tracker, np.asarray(action, float)))
        done = not self._world.reason
        return self._seen(), float(done), done, False, self._info()

    def render(self) -> np.ndarray | None:
        return self._world.picture(self._world.cameras[0]) if self.render_mode == "rgb_array" else None

    def _joints(self, tracker: Tracker, action: np.ndarray) -> np.ndarray:
        """Those that bring the tool to the action's pose, or as near as it gets, without a jump from where they are to be now."""
        if action.shape != (8,) or not np.isfinite(action).all() or not action[3:7].any():
            raise BadInput("action：应为 x y z qw qx qy qz 与夹爪指令" if language() == "zh"
                           else "action: expected x y z qw qx qy qz and the gripper")
        joints, pose = self._world.joint_reference, Pose(action[:3], quat=action[3:7])
        for _ in range(TRACKED):
            joints = tracker.step(pose, joints).q
        return np.append(joints, action[7])

    def _seen(self) -> Seen:
        world = self._world
        return {"agent_pos": np.append(world.joint_position, world.gripper).astype(np.float32),
                "environment_state": world.object_poses.astype(np.float32),
                "pixels": {name: world.picture(name) for name in world.cameras}}

    def _info(self) -> dict[str, Any]:
        return {"is_success": not self._world.reason, "reason": self._world.reason}


gymnasium.register(  # pyright: ignore[reportUnknownMemberType]
    ID, entry_point=ENTRY)
