"""Runs other planners on the whole models of `mjarm bench plan --set near`.

Usage: near.py JOB.json ANSWERS.jsonl (mjarm calls it). Each peer runs in a process of its own, in one thread, each
problem once, with its world ready; and the first problem of each scene once before that, with the clock round all
from the file: model, world, plan. Whether a path is free of collisions is judged by mjarm.
"""

import math
import time

import driver
import planning

# Each maker takes the job and gives three functions: open_world(file) -> world, plan(world, problem) -> path or None,
# and move(world, problem) -> seconds of its own motion beside that path within the job's limits of velocity and
# acceleration, or None; null where the peer has no motions.


def pose_matrix(pose):
    """4 x 4, from a place and a quaternion."""
    import mujoco
    import numpy

    turned = numpy.zeros(9)
    mujoco.mju_quat2Mat(turned, numpy.array(pose["quat"]))
    matrix = numpy.eye(4)
    matrix[:3, :3] = turned.reshape(3, 3)
    matrix[:3, 3] = pose["pos"]
    return matrix


def load(file):
    """A model and its data at home, placed."""
    import mujoco

    model = mujoco.MjModel.from_xml_path(file)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("home").id)
    mujoco.mj_forward(model, data)
    return model, data


def last_body(model, joints):
    return model.body(int(model.jnt_bodyid[model.joint(joints[-1]).id])).name


def sscbirrt(job, **settings):
    """On its own copy of MuJoCo's geometry, else with its defaults; a pose is a region without room, solved by ssik.

    Its motions are its paths smoothed by shortcuts in time, with its defaults: the same search once more, as its seed is.
    """
    import numpy
    import sscbirrt.mujoco as library
    from sscbirrt import CBiRRTConfig, TrajectoryOptions
    from sscbirrt.backends.native_mujoco import NativeScene
    from tsr import TSR

    config = CBiRRTConfig(timeout=job["limit"], **settings)
    limits = TrajectoryOptions(velocity_limits=job["velocity"], acceleration_limits=job["acceleration"])

    def open_world(file):
        model, data = load(file)
        arm = library.Arm(model, job["joints"], ee_site=job["tip"], mjcf=job["robot"])
        NativeScene.from_model(model, job["joints"], ())  # kept for the plans
        return model, data, arm

    def solve(world, problem, **more):
        model, data, arm = world
        if "goal" in problem:
            goal = numpy.array(problem["goal"])
        else:
            goal = TSR(T0_w=pose_matrix(problem["pose"]), Bw=numpy.zeros((6, 2)))
        start = numpy.array(problem["start"])
        found = library.plan(model, data, arm, goal=goal, start=start, config=config, seed=1, **more)
        return found if found.success else None

    def plan(world, problem):
        found = solve(world, problem)
        return found and found.path

    def move(world, problem):
        found = solve(world, problem, trajectory=limits)
        return found and found.trajectory.duration

    return open_world, plan, move


def turned_near(q, start, lower, upper):
    """Each joint in the turn that is nearest to the start; None where that is beyond a limit."""
    out = []
    for value, first, low, high in zip(q, start, lower, upper):
        near = value - 2 * math.pi * round((value - first) / (2 * math.pi))
        value = near if low <= near <= high else value
        if not low <= value <= high:
            return None
        out.append(value)
    return out


def ompl(job, spacing=None):
    """RRT-Connect; MuJoCo says which states are free, ssik which joint values have the tool at a pose."""
    import mujoco
    import numpy
    import ssik

    limits = job["lower"], job["upper"]

    def open_world(file):
        model, data = load(file)
        at = [int(model.jnt_qposadr[model.joint(name).id]) for name in job["joints"]]
        body = last_body(model, job["joints"])
        solver = ssik.Manipulator.from_mjcf(job["robot"], base="world", ee=body)

        def pose_of(place):
            return pose_matrix({"pos": place.xpos, "quat": to_quat(place.xmat)})

        tool = numpy.linalg.inv(pose_of(data.body(body))) @ pose_of(data.site(job["tip"]))

        def is_free(q):
            data.qpos[at] = q
            mujoco.mj_kinematics(model, data)
            mujoco.mj_collision(model, data)
            return data.ncon == 0

        return is_free, solver, numpy.linalg.inv(tool)

    def to_quat(matrix):
        quat = numpy.zeros(4)
        mujoco.mju_mat2Quat(quat, matrix)
        return quat

    def goals_of(problem, is_free, solver, flange):
        if "goal" in problem:
            return [problem["goal"]]
        found = solver.solve(pose_matrix(problem["pose"]) @ flange)
        rows = [turned_near([float(v) for v in answer.q], problem["start"], *limits) for answer in found]
        return [q for q in rows if q is not None and is_free(q)]

    def plan(world, problem):
        is_free, solver, flange = world
        goals = goals_of(problem, is_free, solver, flange)
        if not goals:
            return None
        return planning.rrt_connect(limits, is_free, problem["start"], goals, job["limit"], spacing)

    return open_world, plan, None


PEERS = {
    "sscbirrt": (sscbirrt, "sscbirrt"),
    "sscbirrt, 0.01 rad": (lambda job: sscbirrt(job, edge_resolution=0.01), "sscbirrt"),
    "OMPL + MuJoCo": (ompl, "ompl"),
    "OMPL + MuJoCo, 0.01 rad": (lambda job: ompl(job, 0.01), "ompl"),
}
SAMPLED = ("OMPL + MuJoCo, 0.01 rad",)  # too slow for every problem


class Answers:
    """What one peer answers in one case."""

    def __init__(self):
        self.row = {"problems": [], "us": [], "paths": []}

    def add(self, problem, us, path, **more):
        self.row["problems"].append(problem["id"])
        self.row["us"].append(us)
        self.row["paths"].append(planning.rows_of(path))
        for key, value in more.items():
            self.row.setdefault(key, []).append(value)


def microseconds_since(start):
    return (time.perf_counter_ns() - start) / 1000


def run_peer(job, name, maker, row):
    open_world, plan, move = maker(job)
    cases = {"joints": Answers(), "pose": Answers(), "first": Answers()}
    errors = {}
    met = {"joints": 0, "pose": 0}  # problems, tried or not

    def timed(case, opened_world, problem, start, **more):
        path = None
        try:
            path = plan(opened_world, problem)
        except Exception as error:  # no path; why is told once a case
            errors.setdefault(case, (str(error).splitlines() or [type(error).__name__])[0])
        us = microseconds_since(start)
        if move and case != "first":
            try:
                more["motions"] = move(opened_world, problem) if path is not None else None
            except Exception:  # a path without a motion
                more["motions"] = None
        cases[case].add(problem, us, path, **more)

    open_world(job["scenes"][0]["file"])  # lazy imports
    for scene in job["scenes"]:
        start = time.perf_counter_ns()
        world = open_world(scene["file"])
        opened = microseconds_since(start)
        timed("first", world, scene["problems"][0], start, world=opened)
        for problem in scene["problems"]:
            case = "joints" if "goal" in problem else "pose"
            if name not in SAMPLED or met[case] % job["every"] == 0:
                timed(case, world, problem, time.perf_counter_ns())
            met[case] += 1
    rows = [row | {"set": case} | answers.row for case, answers in cases.items() if answers.row["problems"]]
    return rows + [row | {"set": case, "error": error[:80]} for case, error in errors.items()]


if __name__ == "__main__":
    driver.start(PEERS, run_peer)
