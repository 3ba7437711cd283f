"""The task of `mjarm train` as environments of gymnasium, and policies."""

import json
import subprocess
import sys

import numpy as np
import pytest

import mjarm

gymnasium = pytest.importorskip("gymnasium")
import mjarm.gym  # noqa: E402
from gymnasium.utils.env_checker import check_env  # noqa: E402


@pytest.mark.filterwarnings("error", "ignore:.*infinity. This is probably too")
def test_the_checker_of_gymnasium_finds_nothing():
    check_env(gymnasium.make("mjarm/Reach-v0").unwrapped, skip_render_check=True)


def test_episodes_end_and_begin():
    env = gymnasium.make("mjarm/Reach-v0", episode_steps=5)
    first, info = env.reset(seed=3)
    assert first.shape == env.observation_space.shape and info["goal"].shape == (3,)
    for i in range(5):
        last, reward, terminated, truncated, info = env.step(env.action_space.sample() * 0)
        assert not terminated and truncated == (i == 4) and np.isfinite(reward) and info["distance"] > 0
    assert np.linalg.norm(last[:7] - first[:7]) < 0.2  # of the episode that ended, not of the next
    assert np.array_equal(first, env.reset(seed=3)[0])
    assert not np.array_equal(env.reset()[0], env.reset()[0])


def test_many_are_as_one():
    """Each copy of a vector is the same task, and the first one the same world, to the last bit."""
    one = gymnasium.make("mjarm/Reach-v0", episode_steps=8)
    many = gymnasium.make_vec("mjarm/Reach-v0", num_envs=6, episode_steps=8)
    a, _ = one.reset(seed=5)
    b, _ = many.reset(seed=5)
    assert b.shape == (6, *a.shape) and np.array_equal(a, b[0])
    rng = np.random.default_rng(1)
    for i in range(8):
        actions = rng.uniform(-1, 1, many.action_space.shape).astype(np.float32)
        a, reward, _, truncated, _ = one.step(actions[0])
        b, rewards, terminations, truncations, info = many.step(actions)
        assert reward == pytest.approx(float(rewards[0]), abs=0)
        if i < 7:
            assert np.array_equal(a, b[0]) and not truncations.any()
    assert truncated and truncations.all() and info["_final_obs"].all()
    assert np.array_equal(a, info["final_obs"][0])
    assert not np.array_equal(a, b[0])  # another episode


def test_pictures():
    env = gymnasium.make("mjarm/Reach-v0", render_mode="rgb_array")
    env.reset(seed=1)
    try:
        picture = env.render()
    except mjarm.NotAvailable:
        pytest.skip("no OpenGL on this machine")
    assert picture.shape == (480, 640, 3) and picture.std() > 5
    batch = env.unwrapped._batch
    assert [batch.render(0, width, 90).shape for width in (120, 160)] == [(90, 120, 3), (90, 160, 3)]


def test_the_shipped_policy_reaches():
    policy = mjarm.Policy.load("reach")
    env = gymnasium.make_vec("mjarm/Reach-v0", num_envs=20)
    observations, _ = env.reset(seed=2)
    for _ in range(49):
        observations, _, _, _, info = env.step(policy.act(observations))
    assert np.median(info["distance"]) < 0.01
    assert np.array_equal(policy.act(observations)[3], policy.act(observations[3]))
    told = policy.evaluate(episodes=20)
    assert told["within_2cm"] > 0.9 and told["distances"].shape == (20,)


def test_the_same_as_the_program(tmp_path):
    done = subprocess.run([sys.executable, "-m", "mjarm", "eval", str(mjarm.Policy.load("reach").file), "--episodes", "20",
                           "--out", str(tmp_path / "out")], capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    told = json.loads((tmp_path / "out" / "report.json").read_text(encoding="utf-8"))
    assert told["distance"]["median"] == mjarm.Policy.load("reach").evaluate(episodes=20)["median"]


def test_what_is_wrong(tmp_path):
    with pytest.raises(mjarm.Error, match="tutorial"):
        gymnasium.make("mjarm/Reach-v0", region="tutorail")
    with pytest.raises(ValueError, match="rgb_array"):
        mjarm.gym.ReachEnv(render_mode="human")
    env = mjarm.gym.ReachEnv()
    env.reset(seed=1)
    with pytest.raises(mjarm.BadInput, match=r"\(1, 7\)"):
        env.step(np.zeros(6))
    with pytest.raises(mjarm.BadInput):
        env.step(np.full(7, np.nan))
    (tmp_path / "a.safetensors").write_bytes(b"no")
    with pytest.raises(mjarm.BadInput, match="a.safetensors"):
        mjarm.Policy.load(tmp_path / "a.safetensors")
    with pytest.raises(mjarm.BadInput, match="did you mean .reach."):
        mjarm.Policy.load("rech")
    with pytest.raises(mjarm.BadInput):
        mjarm.Policy.load("no_such")
    with pytest.raises(mjarm.BadInput, match="shape"):
        mjarm.Policy.load("reach").act(np.zeros(3))
