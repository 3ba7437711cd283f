"""A policy in gymnasium: how often it ends within 2 cm of goals it has never seen, beside random actions; and why the
tutorial's task is learned slowly."""

import gymnasium
import numpy as np

import mjarm
import mjarm.gym  # makes "mjarm/Reach-v0" known

panda = mjarm.Robot("panda")
policy = mjarm.Policy.load("reach")


def episode(env, act, seed):
    """How far the tool is from the goal after each action [m], and where it is (n, 3)."""
    observation, _ = env.reset(seed=seed)
    distance, tool, over = [], [], False
    while not over:
        observation, _, terminated, truncated, info = env.step(act(observation))
        distance.append(info["distance"])
        tool.append(observation[14:17] if len(observation) > 17 else panda.fk(observation[:7].astype(float)).pos)
        over = terminated or truncated
    return distance, np.array(tool)


env = gymnasium.make("mjarm/Reach-v0")
env.action_space.seed(1)
learned = [episode(env, policy.act, seed)[0][-1] for seed in range(100)]
chance = [episode(env, lambda _: env.action_space.sample(), seed)[0][-1] for seed in range(100)]
print(f"shipped policy: {np.sum(np.array(learned) < 0.02)} of 100 within 2 cm, random actions: {np.sum(np.array(chance) < 0.02)}")

for name, task in ("mjarm", {}), ("tutorial", {"guide": True}):
    env = gymnasium.make("mjarm/Reach-v0", **task)
    env.action_space.seed(1)
    tool = episode(env, lambda _: env.action_space.sample(), 1)[1]
    step = np.median(np.linalg.norm(np.diff(tool, axis=0), axis=1))
    print(f"{name}: {len(tool)} actions an episode, each moves the tool by {1e3 * step:.1f} mm")
raise SystemExit(not (np.max(learned) < 0.02 and np.min(chance) > 0.02))
