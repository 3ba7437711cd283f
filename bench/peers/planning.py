"""Runs other planners on the problems of `mjarm bench plan`.

Usage: planning.py JOB.json ANSWERS.jsonl (mjarm calls it). Each peer runs in a process of its own, in one thread,
each problem once. The clock stands round all from the obstacles' numbers to a simplified path: world, planner,
simplification. Whether a path is free of collisions is judged by mjarm.
"""

import gzip
import json
import math
import time

import driver
import planning_world

# Each maker takes the job and the robot of its file and gives two functions: prepare(problem) -> arguments, and
# call(*arguments) -> (path or None, extra), which is timed; `extra` holds the peer's own clocks [us].


def rrt_connect(limits, is_free, start, goals, limit, spacing=None):
    """A path by OMPL's RRT-Connect and its own simplification, each in `limit` [s]; None where there is none.

    limits: (lower, upper) of the joints; is_free: joint values -> whether nothing touches.
    spacing: [rad, L2] at which motions are looked at; None: the library's own, 1 % of the space's extent.
    """
    from ompl import base, geometric, util

    util.setLogLevel(util.LOG_NONE)
    dof = len(start)
    space = base.RealVectorStateSpace(dof)
    bounds = base.RealVectorBounds(dof)
    for i, (lower, upper) in enumerate(zip(*limits)):
        bounds.setLow(i, lower)
        bounds.setHigh(i, upper)
    space.setBounds(bounds)
    setup = geometric.SimpleSetup(space)
    information = setup.getSpaceInformation()
    setup.setStateValidityChecker(lambda state: is_free(state[0:dof]))
    if spacing:
        information.setStateValidityCheckingResolution(spacing / space.getMaximumExtent())

    def state_of(q):
        state = space.allocState()
        state[0:dof] = q
        return state

    setup.setStartState(state_of(start))
    states = base.GoalStates(information)
    for goal in goals:
        states.addState(state_of(goal))
    setup.setGoal(states)
    setup.setPlanner(geometric.RRTConnect(information))
    setup.solve(limit)
    if not setup.haveExactSolutionPath():
        return None
    setup.simplifySolution(limit)
    return [state[0:dof] for state in setup.getSolutionPath().getStates()]


def ompl(job, robot, spacing=None):
    """RRT-Connect and the library's own simplification; MuJoCo says which states are free."""

    def call(problem):
        clock = time.perf_counter_ns()
        is_free = planning_world.checker(robot, problem["obstacles"])
        us = (time.perf_counter_ns() - clock) / 1000
        limits = robot["lower"], robot["upper"]
        path = rrt_connect(limits, is_free, problem["start"], problem["goals"], job["limit"], spacing)
        return path, {"world": us}

    return lambda problem: (problem,), call


def fixed_axes(quat):
    """Angles about the fixed axes x, y, z of a rotation."""
    w, x, y, z = (v / math.hypot(*quat) for v in quat)
    pitch = math.asin(max(-1.0, min(1.0, 2 * (w * y - x * z))))
    roll = math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    return [roll, pitch, math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))]


def vamp(job, robot, iterations=None):
    """With the settings of its own benchmark, but room for 100,000 samples instead of a million, as ours has:

    to make that room is most of its time. With a number of iterations: its anytime planner, for so long.
    """
    import vamp as library

    if robot["name"] not in library.robots:
        raise NotImplementedError("no generated code for this arm")
    algorithm = "aorrtc" if iterations else "rrtc"
    module, planner, settings, simplify = library.configure_robot_and_planner_with_kwargs(robot["name"], algorithm)
    settings.max_samples = settings.max_iterations = 100_000
    if iterations:
        settings.rrtc.max_samples = settings.max_samples
        settings.max_iterations = settings.max_internal_iterations = iterations
    sampler = module.halton()

    def solid(obstacle):
        """A maker, its arguments and where it goes."""
        kind, place = obstacle["type"], [obstacle["pos"]]
        if kind == "sphere":
            return library.Sphere, (*place, obstacle["radius"]), "add_sphere"
        place.append(fixed_axes(obstacle["quat"]))
        if kind == "box":
            return library.Cuboid, (*place, obstacle["half"]), "add_cuboid"
        radius, length = obstacle["radius"], obstacle["length"]
        if obstacle["vamp_as"] == "box":
            return library.Cuboid, (*place, [radius, radius, length / 2]), "add_cuboid"
        return library.Cylinder, (*place, radius, length), "add_capsule"

    def prepare(problem):
        return [solid(obstacle) for obstacle in problem["obstacles"]], problem["start"], problem["goals"]

    def call(solids, start, goals):
        clock = time.perf_counter_ns()
        world = library.Environment()
        for make, words, add in solids:
            getattr(world, add)(make(*words))
        us = (time.perf_counter_ns() - clock) / 1000
        sampler.reset()
        found = planner(start, goals, world, settings, sampler)
        if iterations or not found.solved:  # the anytime planner simplifies by itself
            path = found.path if found.solved else None
            return path, {"world": us, "own": found.nanoseconds / 1000}
        simple = module.simplify(found.path, world, simplify, sampler)
        return simple.path, {"world": us, "own": (found.nanoseconds + simple.nanoseconds) / 1000}

    return prepare, call


PEERS = {
    "VAMP": (vamp, "vamp-planner"),
    "VAMP, AORRTC": (lambda job, robot: vamp(job, robot, 3000), "vamp-planner"),
    "OMPL + MuJoCo": (ompl, "ompl"),
    "OMPL + MuJoCo, 0.01 rad": (lambda job, robot: ompl(job, robot, 0.01), "ompl"),
}
SAMPLED = ("OMPL + MuJoCo", "OMPL + MuJoCo, 0.01 rad")  # too slow for every problem


def rows_of(path):
    """The waypoints, from whatever the library gives."""
    return None if path is None else [[float(v) for v in path[i]] for i in range(len(path))]


def run_peer(job, name, maker, row):
    opened = gzip.open if job["file"].endswith(".gz") else open
    with opened(job["file"], "rt", encoding="utf-8") as file:
        document = json.load(file)
    known = {problem["id"]: problem for problem in document["problems"]}
    asked = job["problems"][:: job["every"] if name in SAMPLED else 1]
    prepare, call = maker(job, document["robot"])
    for key in asked[:1]:
        call(*prepare(known[key]))  # caches and lazy imports
    answer = {"problems": asked, "us": [], "paths": []}
    for key in asked:
        words = prepare(known[key])
        start = time.perf_counter_ns()
        path, clocks = call(*words)
        answer["us"].append((time.perf_counter_ns() - start) / 1000)
        answer["paths"].append(rows_of(path))
        for clock, us in clocks.items():
            answer.setdefault(clock, []).append(us)
    return [row | answer]


if __name__ == "__main__":
    driver.start(PEERS, run_peer)
