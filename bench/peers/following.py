"""Follows the paths of `mjarm bench path` with other libraries, as their users do.

Usage: following.py JOB.json ANSWERS.jsonl (mjarm calls it). Pose after pose, each solved from the answer to the
one before; where a library gives all branches, the nearest is taken. The first pose is tried from each of the
seeds in turn. A path ends at the first pose without an answer. Each peer runs in a process of its own, in one
thread; the clock stands right around the library's own calls, and their sum is the time of a path. Whether
a path is whole is judged by mjarm.
"""

import math
import time

import driver
import ik

# Makers as in ik.py, but pick(answer, seed) knows where the arm stands.


def with_seed(maker):
    def make(job):
        prepare, call, pick = maker(job)
        return prepare, call, lambda answer, seed: pick(answer)

    return make


def nearest_turn(value, seed, lower, upper):
    """The same angle, as near to `seed` as the limits allow."""
    turns = [value + 2 * math.pi * k for k in (-1, 0, 1)]
    fitting = [v for v in turns if lower <= v <= upper]
    return min(fitting or turns, key=lambda v: abs(v - seed))


def turned_to(q, seed, job):
    return [nearest_turn(*joint) for joint in zip(q, seed, job["lower"], job["upper"])]


def eaik(job):
    prepare, call, _ = ik.eaik(job)

    def pick(answer, seed):
        best, least = None, math.inf
        for q, least_squares in zip(answer.Q, answer.is_LS):
            turned = turned_to(q, seed, job)
            away = max(abs(v - s) for v, s in zip(turned, seed))
            if not least_squares and ik.within(turned, job) and away < least:
                best, least = turned, away
        return best

    return prepare, call, pick


def pinocchio(job):
    """The damped least squares loop of its documentation: the library has no solver."""
    import numpy as np
    import pinocchio as pin

    model = pin.buildModelFromUrdf(ik.chain_only(job))
    data = model.createData()
    tip = model.getFrameId(job["tip"])

    def prepare(case):
        target = ik.matrix(case)
        return pin.SE3(target[:3, :3], target[:3, 3]), np.array(case["seed"])

    def call(target, q):
        for _ in range(1000):
            pin.framesForwardKinematics(model, data, q)
            to_target = data.oMf[tip].actInv(target)
            error = pin.log(to_target).vector
            if np.linalg.norm(error) < 1e-4:
                return q
            J = pin.computeFrameJacobian(model, data, q, tip)
            J = -pin.Jlog6(to_target.inverse()) @ J
            q = pin.integrate(model, q, -J.T @ np.linalg.solve(J @ J.T + 1e-12 * np.eye(6), error) * 0.1)
        return None

    if model.nq != len(job["joints"]):
        raise NotImplementedError("joints without limits are not written here")
    return prepare, call, lambda q, seed: None if q is None else turned_to(q, seed, job)


PEERS = {
    "EAIK, nearest": (eaik, "eaik"),
    "ssik": (with_seed(ik.ssik), "ssik"),
    "roboticstoolbox": (with_seed(ik.roboticstoolbox), "roboticstoolbox-python"),
    "TRAC-IK": (with_seed(ik.pytracik), "pytracik"),
    "ikpy": (with_seed(ik.ikpy), "ikpy"),
    "pinocchio, damped": (pinocchio, "pin"),
}


def solve(pose, seed, prepare, call, pick):
    """Time of the call [us], and the joint values or None."""
    words = prepare(pose | {"seed": seed})
    start = time.perf_counter_ns()
    answer = call(*words)
    us = (time.perf_counter_ns() - start) / 1000
    q = pick(answer, seed)
    return us, None if q is None else [float(v) for v in q]


def follow(path, seeds, solver):
    """Time of a whole path [us], and the joint values as far as it goes."""
    spent, rows = 0, []
    for seed in seeds:
        us, q = solve(path[0], seed, *solver)
        spent += us
        if q is not None:
            rows.append(q)
            break
    for pose in path[1:] if rows else []:
        us, q = solve(pose, rows[-1], *solver)
        spent += us
        if q is None:
            break
        rows.append(q)
    return spent, rows


def run_peer(job, name, maker, row):
    solver = maker(job)
    rows = []
    for group in job["sets"]:
        follow(group["paths"][0][:5], job["seeds"], solver)  # caches and lazy imports
        us, q = [], []
        end = time.monotonic() + driver.SECONDS
        for path in group["paths"]:
            if time.monotonic() > end:
                break
            spent, answers = follow(path, job["seeds"], solver)
            us.append(spent)
            q.append(answers)
        for _ in range(1, job["rounds"]):
            for i, path in enumerate(group["paths"][: len(us)]):
                if time.monotonic() < end:
                    us[i] = min(us[i], follow(path, job["seeds"], solver)[0])
        rows.append(row | {"set": group["name"], "us": us, "q": q})
    return rows


if __name__ == "__main__":
    driver.start(PEERS, run_peer)
