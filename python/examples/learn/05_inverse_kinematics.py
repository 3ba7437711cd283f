"""Inverse kinematics of our own: damped least squares with terms for the limits, beside robot.ik."""

import mujoco
import numpy as np

import mjarm

robot = mjarm.Robot("panda")
model = mujoco.MjModel.from_xml_path(str(robot.file))
data = mujoco.MjData(model)
tool, n, lower, upper = data.site(robot.tip), robot.dof, robot.limits.lower, robot.limits.upper


def own_ik(goal, q, limit_weight, damping=0.05):
    J, turn, now = np.zeros((6, model.nv)), np.zeros(3), np.zeros(4)
    for _ in range(200):
        data.qpos[:n] = q
        mujoco.mj_kinematics(model, data)  # the two parts of mj_forward that are needed here
        mujoco.mj_comPos(model, data)
        mujoco.mj_jacSite(model, data, J[:3], J[3:], tool.id)
        mujoco.mju_mat2Quat(now, tool.xmat)
        mujoco.mju_subQuat(turn, goal.quat, now)  # what is left to turn, in axes of the tool
        error = np.r_[goal.pos - tool.xpos, tool.xmat.reshape(3, 3) @ turn]
        beyond = np.clip(q, lower, upper) - q  # 0 for joints within their limits
        if np.abs(error).max() < 1e-6 and limit_weight * np.abs(beyond).max() < 1e-6:
            return q
        rows = np.vstack([J[:, :n], limit_weight * np.diag(beyond != 0), damping * np.eye(n)])
        step = np.linalg.lstsq(rows, np.r_[error, limit_weight * beyond, np.zeros(n)], rcond=None)[0]
        q = q + step * min(1, 0.3 / np.abs(step).max())


random = np.random.default_rng(1)
goals = [robot.fk(random.uniform(lower, upper)) for _ in range(100)]  # each can be reached
for name, solve in {"own": lambda X: own_ik(X, robot.home, 0), "own + limits": lambda X: own_ik(X, robot.home, 1),
                    "robot.ik": lambda X: robot.ik(X).q}.items():
    found = [q for q in map(solve, goals) if q is not None]
    inside = sum(bool(np.all((lower - 1e-5 < q) & (q < upper + 1e-5))) for q in found)
    print(f"{name:12} {len(found):3} of 100 found, {inside:3} within the limits")
raise SystemExit(0 if inside == 100 else 1)
