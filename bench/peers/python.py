"""Runs the package of Python, and others, for `mjarm bench python`.

Usage: python.py JOB.json ANSWERS.jsonl (mjarm calls it). Three sets: `reachable`, one call of inverse kinematics a case;
`batch`, many poses in one call; `reach`, actions of the environment that `mjarm train` learns in, beside one that is
written as most are, with gymnasium and mujoco in plain Python.
"""

import driver
import ik


def mjarm_calls(job):
    import mjarm
    import numpy as np

    robot = mjarm.Robot(job["urdf"], tip=job["tip"])

    def call(target, seed):
        try:
            return robot.ik(target, seed)
        except mjarm.Unreachable:
            return None

    return lambda case: (ik.matrix(case), np.array(case["seed"])), call, lambda found: None if found is None else found.q


def mjarm_batch(job):
    import mjarm
    import numpy as np

    robot = mjarm.Robot(job["urdf"], tip=job["tip"])
    poses = np.array([ik.matrix(case) for case in job["cases"]])
    poses = poses[np.arange(job["batch"]) % len(poses)]
    return driver.best_mean(job["rounds"], job["batch"], lambda: robot.ik_batch(poses, threads=1))


def mjarm_reach(job):
    import numpy as np
    from mjarm.gym import ReachVectorEnv

    envs = ReachVectorEnv(job["worlds"], threads=1)
    still = np.zeros(envs.action_space.shape, np.float32)
    return driver.best_mean(job["rounds"], job["worlds"] * job["steps"], lambda: [envs.step(still) for _ in range(job["steps"])],
                     lambda: envs.reset(seed=1))


def plain_reach(job):
    import gymnasium
    import mjarm
    import mujoco
    import numpy as np

    class Reach(gymnasium.Env):
        """One world, written as most environments are."""

        def __init__(self):
            self.model = mujoco.MjModel.from_xml_path(str(mjarm.Robot("panda").file.with_name("scene.xml")))
            self.data = mujoco.MjData(self.model)
            self.tool = self.model.site("hand_tcp").id
            self.observation_space = gymnasium.spaces.Box(-np.inf, np.inf, (23,), np.float32)
            self.action_space = gymnasium.spaces.Box(-1, 1, (7,), np.float32)
            self.goal = np.array([0.4, 0.2, 0.3])

        def see(self):
            q, v, p = self.data.qpos[:7], self.data.qvel[:7], self.data.site_xpos[self.tool]
            return np.concatenate((q, v, p, self.goal, self.goal - p)).astype(np.float32)

        def reset(self, *, seed=None, options=None):
            super().reset(seed=seed)
            mujoco.mj_resetDataKeyframe(self.model, self.data, 0)
            return self.see(), {}

        def step(self, action):
            self.data.ctrl[:7] = self.data.qpos[:7] + 0.05 * np.clip(action, -1, 1)
            mujoco.mj_step(self.model, self.data, 20)
            d = np.linalg.norm(self.goal - self.data.site_xpos[self.tool])
            return self.see(), float(-2 * d + 0.5 * np.exp(-d / 0.05)), False, False, {"distance": d}

    worlds = [Reach() for _ in range(job["worlds"])]
    still = np.zeros(7, np.float32)
    return driver.best_mean(job["rounds"], job["worlds"] * job["steps"],
                     lambda: [world.step(still) for _ in range(job["steps"]) for world in worlds],
                     lambda: [world.reset() for world in worlds])


PEERS = {
    "mjarm in Python": (mjarm_calls, "mjarm"),
    "EAIK": (ik.eaik, "eaik"),
    "ssik": (ik.ssik, "ssik"),
    "ikpy": (ik.ikpy, "ikpy"),
    "gymnasium + mujoco": (plain_reach, "gymnasium"),
}


def run_peer(job, name, maker, row):
    if maker is plain_reach:
        return [row | {"set": "reach", "us": maker(job)}]
    prepare, call, pick = maker(job)
    us, answers = driver.best_times([prepare(case) for case in job["cases"]], job["rounds"], call, pick)
    q = [None if values is None else [float(v) for v in values] for values in answers]
    rows = [row | {"set": "reachable", "us": us, "q": q}]
    if maker is mjarm_calls:
        rows += [row | {"set": "batch", "us": mjarm_batch(job)}, row | {"set": "reach", "us": mjarm_reach(job)}]
    return rows


if __name__ == "__main__":
    driver.start(PEERS, run_peer)
