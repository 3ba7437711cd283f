"""The task of `mjarm bench rl` for stable-baselines3: the same model, start, goals, actions, observations and reward.

Written as fast as this goes in Python: all arithmetic in numpy over all copies at once, the simulation on threads of
its own (mj_step gives up the interpreter's lock).
"""

from concurrent.futures import ThreadPoolExecutor

import gymnasium
import mujoco
import numpy as np
from stable_baselines3.common.vec_env import VecEnv

MOST_AHEAD = 3  # greatest steps that a reference may be ahead of its joint
COARSE, FINE = 0.25, 0.02  # [m] see ReachEnv
SURROUNDINGS, ARM, FINGER = range(3)


def parts_of(model, first_joint, fingers):
    """To what each geom belongs when contacts are counted."""
    of_body = np.full(model.nbody, SURROUNDINGS)
    of_body[model.joint(first_joint).bodyid] = ARM
    for name in fingers:
        of_body[model.joint(name).bodyid] = FINGER
    for body in range(1, model.nbody):  # parents come first
        if of_body[body] != FINGER:
            of_body[body] = max(of_body[body], of_body[model.body_parentid[body]])
    return of_body[model.geom_bodyid]


class Reach(VecEnv):
    """Copies of the arm that begin and end their episodes together."""

    def __init__(self, task, goals, count, threads):
        """goals: (n, 3) [m], of which each episode takes the next."""
        self.model = model = mujoco.MjModel.from_xml_path(task["model"])
        self.datas = [mujoco.MjData(model) for _ in range(count)]
        self.pool = ThreadPoolExecutor(threads) if threads > 1 else None
        self.chunks = np.array_split(np.arange(count), threads)
        self.task, self.goals, self.next_goal = task, np.array(goals), 0

        joints = [model.joint(name) for name in task["joints"]]
        self.qpos = np.array([joint.qposadr[0] for joint in joints])
        self.dof = np.array([joint.dofadr[0] for joint in joints])
        self.actuator = np.array([model.actuator(name).id for name in task["actuators"]])
        self.site = model.site(task["tool"]).id
        self.part = parts_of(model, task["joints"][0], task["fingers"])
        self.damping = model.dof_damping[self.dof].ravel()
        self.gain = model.actuator_gainprm[self.actuator, 0]
        self.bias = model.actuator_biasprm[self.actuator, :3].T
        self.lower, self.upper = np.array(task["lower"]), np.array(task["upper"])
        self.speed = np.array(task["speed"])
        self.period = task["frame_skip"] * model.opt.timestep

        n, k = count, len(joints)
        self.q, self.v, self.gravity, self.ctrl = (np.zeros((n, k)) for _ in range(4))
        self.p, self.R = np.zeros((n, 3)), np.zeros((n, 9))
        self.touching = np.zeros(n, dtype=bool)
        box = lambda bound, size: gymnasium.spaces.Box(-bound, bound, (size,), np.float32)
        super().__init__(n, box(np.inf, 2 * k + 18), box(1.0, k))

    def everywhere(self, work):
        """Does `work(i)` for every copy."""

        def chunk(copies):
            for i in copies:
                work(i)

        list((self.pool.map if self.pool else map)(chunk, self.chunks))

    def read(self, i):
        data = self.datas[i]
        self.q[i], self.v[i] = data.qpos[self.qpos], data.qvel[self.dof]
        self.gravity[i] = data.qfrc_bias[self.dof]
        self.p[i], self.R[i] = data.site_xpos[self.site], data.site_xmat[self.site]
        self.touching[i] = data.ncon > 0 and self.touches(data.contact)

    def touches(self, contact):
        parts = self.part[contact.geom[(contact.dist <= contact.includemargin) & (contact.exclude == 0)]]
        return bool((parts.max(axis=1, initial=0) > 0)[~(parts == FINGER).all(axis=1)].any())

    def advance(self, i):
        data = self.datas[i]
        data.ctrl[self.actuator] = self.ctrl[i]
        # Each step's second half, and the first of the next: what is read is up to date, nothing is computed twice.
        mujoco.mj_step2(self.model, data)
        mujoco.mj_step(self.model, data, self.task["frame_skip"] - 1)
        mujoco.mj_step1(self.model, data)
        self.read(i)

    def begin(self, i):
        data = self.datas[i]
        mujoco.mj_resetData(self.model, data)
        data.qpos[:], data.ctrl[:] = self.task["qpos"], self.task["ctrl"]
        mujoco.mj_step1(self.model, data)
        self.read(i)

    def reset(self):
        wanted = self.next_goal + np.arange(self.num_envs)
        self.goal = self.goals[wanted % len(self.goals)]
        self.next_goal += self.num_envs
        self.everywhere(self.begin)
        self.reference, self.steps = self.q.copy(), 0
        return self.observations()

    def observations(self):
        error = self.goal - self.p
        distance = np.linalg.norm(error, axis=1, keepdims=True)
        middle, half = (self.lower + self.upper) / 2, (self.upper - self.lower) / 2
        axes = self.R.reshape(-1, 3, 3)[:, :, :2].transpose(0, 2, 1).reshape(-1, 6)
        parts = (
            (self.q - middle) / half,
            self.v / self.speed,
            self.p,
            axes,
            self.goal,
            error / COARSE,
            error / (distance + FINE),
        )
        return np.concatenate(parts, axis=1).astype(np.float32)

    def command(self, actions):
        """Moves the references; what the servos need for that, gravity fed forward."""
        step = self.speed * self.period
        wanted = self.reference + actions * step
        wanted = np.clip(wanted, self.q - MOST_AHEAD * step, self.q + MOST_AHEAD * step)
        wanted = np.clip(wanted, self.lower, self.upper)
        q, v = (self.reference + wanted) / 2, (wanted - self.reference) / self.period
        torque = self.gravity + self.damping * v
        self.ctrl = (torque - self.bias[0] - self.bias[1] * q - self.bias[2] * v) / self.gain
        self.reference = wanted

    def move(self, actions):
        """One action of every copy, whatever the time of its episode."""
        self.command(actions)
        self.everywhere(self.advance)

    def distances(self):
        return np.linalg.norm(self.p - self.goal, axis=1)

    def rewards(self, actions):
        w, d = self.task["reward"], self.distances()
        room = np.minimum(self.q - self.lower, self.upper - self.q)
        near = np.clip(1 - room / w["limit_margin"], 0, 1).sum(axis=1)
        return (
            w["coarse"] * np.exp(-d / w["coarse_scale"])
            + w["fine"] * np.exp(-d / w["fine_scale"])
            - w["distance"] * d
            - w["action"] * (actions**2).mean(axis=1)
            - w["collision"] * self.touching
            - w["limit"] * near
        )

    def step_async(self, actions):
        self.actions = np.clip(actions, -1, 1).astype(np.float64)

    def step_wait(self):
        self.move(self.actions)
        self.steps += 1
        rewards, seen = self.rewards(self.actions), self.observations()
        over = self.steps >= self.task["episode_steps"]
        infos = [{} for _ in self.datas]
        if over:  # cut, not ended: what follows counts with the critic's value
            for info, last in zip(infos, seen):
                info["terminal_observation"], info["TimeLimit.truncated"] = last, True
            seen = self.reset()
        return seen, rewards.astype(np.float32), np.full(self.num_envs, over), infos

    def close(self):
        if self.pool:
            self.pool.shutdown()

    def get_attr(self, attr_name, indices=None):
        return [getattr(self, attr_name, None)] * self.num_envs

    def set_attr(self, attr_name, value, indices=None):
        raise NotImplementedError

    def env_method(self, method_name, *arguments, indices=None, **named):
        raise NotImplementedError

    def env_is_wrapped(self, wrapper_class, indices=None):
        return [False] * self.num_envs
