"""Lets stable-baselines3 learn the task of `mjarm bench rl`.

Usage: reaching.py JOB.json ANSWERS.jsonl (mjarm calls it). Its environment is first compared with a trace of ours.
The clock stands while the policy is judged, as it does for mjarm.
"""

import time

import driver


def learner(job):
    """PPO of stable-baselines3 with the settings of mjarm's own."""
    import torch
    from reach_env import Reach
    from stable_baselines3 import PPO
    from stable_baselines3.common.vec_env import VecNormalize

    torch.set_num_threads(job["threads"])
    ppo = job["ppo"]
    env = Reach(job["task"], job["goals"], ppo["environments"], job["threads"])
    layers = {"pi": ppo["actor"], "vf": ppo["critic"]}
    policy = {"net_arch": layers, "activation_fn": torch.nn.Tanh, "log_std_init": ppo["initial_log_std"]}
    return PPO(
        "MlpPolicy",
        VecNormalize(env, norm_reward=False),
        learning_rate=lambda left: left * ppo["learning_rate"],
        n_steps=ppo["rollout_steps"],
        batch_size=ppo["minibatch"],
        n_epochs=ppo["epochs"],
        gamma=ppo["discount"],
        gae_lambda=ppo["gae_lambda"],
        clip_range=ppo["clip"],
        ent_coef=ppo["entropy_weight"],
        vf_coef=ppo["value_weight"],
        max_grad_norm=ppo["max_gradient_norm"],
        policy_kwargs=policy,
        seed=job["seed"],
        device="cpu",
    )


def check_environment(job):
    """Ours and this environment must agree on what follows the same actions."""
    import numpy as np
    from reach_env import Reach

    trace = job["trace"]
    env = Reach(job["task"], [trace["goal"]], 1, 1)
    seen, worst = env.reset(), 0.0
    for step, actions in enumerate(trace["actions"]):
        worst = max(worst, np.abs(seen[0] - np.array(trace["observations"][step])).max())
        env.step_async(np.array([actions]))
        seen, rewards, _, _ = env.step_wait()
        worst = max(worst, abs(rewards[0] - trace["rewards"][step]))
    if not worst < job["tolerance"]:
        raise ValueError(f"its environment differs from ours by {worst:.3g}")


def judge_of(job, start):
    """A callback that judges the policy every so many steps; `curve` has steps, seconds and distances [m]."""
    from reach_env import Reach
    from stable_baselines3.common.callbacks import BaseCallback

    env = Reach(job["task"], job["unseen"], len(job["unseen"]), job["threads"])

    class Judge(BaseCallback):
        def __init__(self):
            super().__init__()
            self.curve, self.paused, self.last = [], 0.0, 0

        def _on_step(self):
            return True

        def _on_rollout_start(self):  # after an update
            every = job["evaluate_every"]
            if self.num_timesteps // every > self.last // every:
                self.look()
            self.last = self.num_timesteps

        def _on_training_end(self):
            self.look()

        def look(self):
            if self.curve and self.curve[-1]["steps"] == self.num_timesteps:
                return
            began = time.monotonic()
            env.next_goal = 0
            seen = env.reset()
            for _ in range(job["task"]["episode_steps"]):
                actions, _ = self.model.predict(self.training_env.normalize_obs(seen), deterministic=True)
                env.move(actions.astype("float64"))
                seen = env.observations()
            seconds, distances = began - start() - self.paused, env.distances().tolist()
            self.curve.append({"steps": self.num_timesteps, "seconds": seconds, "distances": distances})
            self.paused += time.monotonic() - began

    return Judge()


def run(job, name, maker, row):
    check_environment(job)
    model = maker(job)
    began = []
    judge = judge_of(job, lambda: began[0])
    began.append(time.monotonic())
    model.learn(job["ppo"]["total_steps"], callback=judge)
    last = judge.curve[-1]
    yield row | {"set": job["set"], "us": [1e6 * last["seconds"] / last["steps"]], "curve": judge.curve}


PEERS = {"stable-baselines3": (learner, "stable-baselines3")}

if __name__ == "__main__":
    driver.start(PEERS, run)
