"""The tasks of mjarm for LeRobot: `--env.type=mjarm`."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import mjarm.tasks
from lerobot.configs.types import FeatureType, PolicyFeature
from lerobot.envs.configs import EnvConfig
from lerobot.utils.constants import ACTION, OBS_ENV_STATE, OBS_IMAGES, OBS_STATE


@EnvConfig.register_subclass("mjarm")
@dataclass
class MjarmEnvConfig(EnvConfig):
    """What `mjarm.tasks.TaskEnv` takes; features are those of its spaces."""

    task: str | None = "pick_place"
    fps: int = 10
    robot: str = "panda"
    size: int = 128
    action: str = "joint"
    scenes: int = 0
    seconds: float = mjarm.tasks.SECONDS
    features: dict[str, PolicyFeature] = field(default_factory=dict)
    features_map: dict[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        env = mjarm.tasks.TaskEnv(**self._task())
        spaces = env.observation_space
        self.features = {
            ACTION: PolicyFeature(type=FeatureType.ACTION, shape=env.action_space.shape),
            "agent_pos": PolicyFeature(type=FeatureType.STATE, shape=spaces["agent_pos"].shape),
            "environment_state": PolicyFeature(type=FeatureType.ENV, shape=spaces["environment_state"].shape),
        }
        self.features_map = {ACTION: ACTION, "agent_pos": OBS_STATE, "environment_state": OBS_ENV_STATE}
        for camera, space in spaces["pixels"].items():
            self.features[f"pixels/{camera}"] = PolicyFeature(type=FeatureType.VISUAL, shape=space.shape)
            self.features_map[f"pixels/{camera}"] = f"{OBS_IMAGES}.{camera}"

    def _task(self) -> dict[str, Any]:
        return {"task": self.task, "robot": self.robot, "size": self.size, "fps": self.fps, "action": self.action,
                "scenes": self.scenes}

    @property
    def package_name(self) -> str:
        return "mjarm.tasks"

    @property
    def gym_id(self) -> str:
        return mjarm.tasks.ID

    @property
    def gym_kwargs(self) -> dict[str, Any]:
        return {**self._task(), "render_mode": "rgb_array", "max_episode_steps": round(self.seconds * self.fps)}
