"""The task of `mjarm train reach` as environments of gymnasium.

>>> import gymnasium, mjarm.gym
>>> env = gymnasium.make("mjarm/Reach-v0")
>>> envs = gymnasium.make_vec("mjarm/Reach-v0", num_envs=64)

Keywords are those of the task: region ("tutorial", "wide"), action ("joint_delta", "joint_velocity", "joint_position",
"torque"), orientation, obstacle, frame_skip, episode_steps, ... Observations and rewards are those of `mjarm train`.
"""

from __future__ import annotations

import os
from typing import Any

try:
    import gymnasium
except ModuleNotFoundError as missing:
    from .errors import NotAvailable

    raise NotAvailable("mjarm.gym needs gymnasium (需要 gymnasium): pip install gymnasium") from missing
import numpy as np
from gymnasium.vector.utils import batch_space

from ._core import ReachBatch, language

ID = "mjarm/Reach-v0"


def _check(render_mode: str | None) -> None:
    if render_mode not in (None, "rgb_array"):
        raise ValueError(f"render_mode：应为 None 或 rgb_array，而不是 {render_mode!r}" if language() == "zh"
                         else f"render_mode: expected None or rgb_array, not {render_mode!r}")


def _spaces(batch: ReachBatch) -> tuple[gymnasium.spaces.Box, gymnasium.spaces.Box]:
    return (
        gymnasium.spaces.Box(-np.inf, np.inf, (batch.observation_size,), np.float32),
        gymnasium.spaces.Box(-1, 1, (batch.action_size,), np.float32),
    )


class ReachEnv(gymnasium.Env):
    """One arm that learns to bring its tool to goals; `info["distance"]` [m] tells how far it is off."""

    metadata = {"render_modes": ["rgb_array"]}

    def __init__(self, render_mode: str | None = None, **task: Any) -> None:
        _check(render_mode)
        self._batch = ReachBatch(**task)
        self.metadata = self.metadata | {"render_fps": self._batch.fps}
        self.render_mode = render_mode
        self.observation_space, self.action_space = _spaces(self._batch)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[np.ndarray, dict[str, Any]]:
        super().reset(seed=seed)
        first = self._batch.reset(int(self.np_random.integers(2**63)) if seed is None else seed)
        return first[0], {"goal": self._batch.goal()}

    def step(self, action: np.ndarray) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        after, reward, terminated, truncated = self._batch.step(np.asarray(action)[None])
        if terminated[0] or truncated[0]:  # the batch has begun another episode
            after = self._batch.final_observations
        info = {"distance": float(self._batch.distances[0])}
        return after[0], float(reward[0]), bool(terminated[0]), bool(truncated[0]), info

    def render(self) -> np.ndarray | None:
        return self._batch.render() if self.render_mode == "rgb_array" else None


class ReachVectorEnv(gymnasium.vector.VectorEnv):
    """Many of them, stepped together in C++ on all cores; an episode that ends begins anew in the same step."""

    metadata = {"render_modes": ["rgb_array"], "autoreset_mode": gymnasium.vector.AutoresetMode.SAME_STEP}

    def __init__(self, num_envs: int = 1, render_mode: str | None = None, threads: int | None = None, **task: Any) -> None:
        _check(render_mode)
        self._batch = ReachBatch(environments=num_envs, threads=threads or len(os.sched_getaffinity(0)), **task)
        self.num_envs = num_envs
        self.render_mode = render_mode
        self.single_observation_space, self.single_action_space = _spaces(self._batch)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[np.ndarray, dict[str, Any]]:
        super().reset(seed=seed)
        return self._batch.reset(int(self.np_random.integers(2**63)) if seed is None else seed), {}

    def step(self, actions: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        after, rewards, terminated, truncated = self._batch.step(actions)
        info: dict[str, Any] = {"distance": self._batch.distances, "_distance": np.ones(self.num_envs, bool)}
        ended = terminated | truncated
        if ended.any():
            final = np.full(self.num_envs, None, dtype=object)
            for i in np.flatnonzero(ended):
                final[i] = self._batch.final_observations[i]
            info |= {"final_obs": final, "_final_obs": ended}
        return after, rewards, terminated, truncated, info

    def render(self) -> tuple[np.ndarray, ...] | None:
        if self.render_mode != "rgb_array":
            return None
        return tuple(self._batch.render(i) for i in range(self.num_envs))


gymnasium.register(  # pyright: ignore[reportUnknownMemberType]
    ID, entry_point=ReachEnv, vector_entry_point=ReachVectorEnv)
