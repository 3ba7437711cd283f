"""The scenes of `mjarm record` as environments of gymnasium: what was recorded is done again."""

import io
import json
import subprocess
import sys
import zipfile

import numpy as np
import pytest

import mjarm

gymnasium = pytest.importorskip("gymnasium")
import mjarm.tasks  # noqa: E402
from gymnasium.utils.env_checker import check_env  # noqa: E402

SEED = 4


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """The entries of an episode."""
    out = tmp_path_factory.mktemp("recorded")
    done = subprocess.run([sys.executable, "-m", "mjarm", "record", "reach", "--out", str(out), "--size", "24", "--episodes", "1",
                           "--seed", str(SEED)], capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    with zipfile.ZipFile(out / "episode_000000.zip") as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def column(recorded, name):
    return np.load(io.BytesIO(recorded[f"{name}.npy"]))


def make(**task):
    return gymnasium.make("mjarm/Task-v0", task="reach", size=24, **task)


@pytest.mark.filterwarnings("error", "ignore:.*infinity. This is probably too", "ignore:.*not within the", "ignore:.*image",
                            "ignore:.*symmetric and normalized")
def test_the_checker_of_gymnasium_finds_nothing():
    check_env(make(render_mode="rgb_array").unwrapped)


@pytest.mark.parametrize("action", ["joint", "tool"])
def test_what_was_recorded_succeeds_again(recorded, action):
    env = make(scenes=SEED, action=action)
    seen, info = env.reset(options={"number": 0})
    about = json.loads(recorded["episode.json"])
    assert env.unwrapped.task_description == about["language"]["en"] and not info["is_success"]
    joints, tool = np.hstack([column(recorded, "joint_position"), column(recorded, "gripper")]), column(recorded, "tool_pose")
    np.testing.assert_array_equal(seen["environment_state"], column(recorded, "object_poses")[0].astype(np.float32))
    for row, one in enumerate(column(recorded, f"action_{action}")):
        if action == "joint":  # of poses seven joints take others, whose limits may keep the tool behind on its way
            assert np.abs(seen["agent_pos"] - joints[row]).max() < 0.02
            assert np.linalg.norm(env.unwrapped._world.tool_pose[:3] - tool[row, :3]) < 5e-3
        seen, reward, terminated, truncated, info = env.step(one.astype(np.float32))
        if terminated:
            break
    assert reward == 1 and terminated and not truncated and info["is_success"] and row > 3


def test_seeds_draw_scenes():
    env = make()
    first = [env.reset(seed=seed)[0]["environment_state"] for seed in (1, 2, 1)]
    assert np.array_equal(first[0], first[2]) and not np.array_equal(first[0], first[1])
    assert not np.array_equal(env.reset()[0]["environment_state"], env.reset()[0]["environment_state"])


def test_pictures_are_those_of_the_episode(recorded):
    image = pytest.importorskip("PIL.Image")
    seen, _ = make(scenes=SEED).reset(options={"number": 0})
    for camera, picture in seen["pixels"].items():
        np.testing.assert_array_equal(picture, np.asarray(image.open(io.BytesIO(recorded[f"frames/{camera}/000000.png"]))))


def test_what_is_wrong_is_told():
    for wrong, told in (({"task": "sweep"}, "sweep"), ({"robot": "pr2"}, "panda"), ({"action": "torque"}, "joint, tool"),
                        ({"render_mode": "human"}, "rgb_array"), ({"size": 3}, "size")):
        with pytest.raises(mjarm.BadInput, match=told):
            mjarm.tasks.TaskEnv(**wrong)
    joint, tool = make(), make(action="tool")
    for env, wrong in ((joint, np.zeros(7)), (joint, np.full(8, np.nan)), (tool, np.zeros(8)), (tool, np.full(8, np.inf))):
        env.reset(seed=1)
        with pytest.raises(mjarm.BadInput, match="action"):
            env.unwrapped.step(wrong)
    for _ in range(20):  # out of reach: as near as it gets
        seen = tool.step(np.array([9, 9, 9, 0, 1, 0, 0, 1]))[0]
    assert np.isfinite(seen["agent_pos"]).all() and seen["agent_pos"][-1] == 1
