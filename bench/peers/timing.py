"""Runs other libraries on the motions of `mjarm bench time`.

Usage: timing.py JOB.json ANSWERS.jsonl (mjarm calls it). Each peer runs in a process of its own, in one
thread. The clock stands right around the library's own calls from waypoints or states to a trajectory.
Whether that arrives and keeps the limits is judged by mjarm, from states at equal intervals of time.
"""

import logging
import os
import tempfile

import driver

# Each maker takes a set and gives three functions, or None where the library has no such problem:
# prepare(case) -> arguments, call(*arguments) -> whatever the library returns, which is timed, and
# pick(that) -> (duration, states of shape (samples + 1, 3, dof)), or None for "no".


def chord(points):
    """Parameter of each point: the length of the chords so far."""
    import numpy as np

    return np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])


def bounds(group):
    import numpy as np

    return [np.array(group["limits"][key]) for key in "vaj"]


def chain(group):
    """A URDF of as many joints: some libraries take their limits from a robot."""
    links = '<link name="l0"/>'
    for i, v in enumerate(group["limits"]["v"]):
        links += (
            f'<link name="l{i + 1}"><inertial><mass value="1"/>'
            '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>'
            f'<joint name="j{i}" type="revolute"><parent link="l{i}"/><child link="l{i + 1}"/>'
            f'<axis xyz="0 {i % 2} {1 - i % 2}"/><limit lower="-100" upper="100" velocity="{v}" effort="1"/></joint>'
        )
    return f'<robot name="chain">{links}</robot>'


def ruckig(group):
    """Point to point; through waypoints by stopping at each: without its cloud it does no better."""
    import numpy as np
    from ruckig import InputParameter, Result, Ruckig, Trajectory

    if group["problem"] not in ("p2p", "via_vaj"):
        return None
    v, a, j = group["limits"]["v"], group["limits"]["a"], group["limits"]["j"]
    otg = Ruckig(len(v))

    def leg(q0, q1, v0=None, a0=None, v1=None, a1=None):
        still = [0.0] * len(v)
        inputs = InputParameter(len(v))
        inputs.current_position, inputs.target_position = q0, q1
        inputs.current_velocity, inputs.current_acceleration = v0 or still, a0 or still
        inputs.target_velocity, inputs.target_acceleration = v1 or still, a1 or still
        inputs.max_velocity, inputs.max_acceleration, inputs.max_jerk = v, a, j
        return inputs, Trajectory(len(v))

    def prepare(case):
        if group["problem"] == "p2p":
            legs = [leg(*(case[key] for key in ("q0", "q1", "v0", "a0", "v1", "a1")))]
        else:
            legs = [leg(*ends) for ends in zip(case["waypoints"], case["waypoints"][1:])]
        return legs, [trajectory for _, trajectory in legs]

    def call(legs, motion):
        for inputs, trajectory in legs:
            if otg.calculate(inputs, trajectory) not in (Result.Working, Result.Finished):
                return None
        return motion

    def pick(motion):
        if motion is None:
            return None
        ends = np.cumsum([trajectory.duration for trajectory in motion])
        states = []
        for t in np.linspace(0, ends[-1], group["samples"] + 1):
            k = min(int(np.searchsorted(ends, t)), len(motion) - 1)
            states.append(motion[k].at_time(t - ends[k] + motion[k].duration)[:3])
        return ends[-1], states

    if group["problem"] == "p2p":  # no loop of Python's around the one call

        def call(legs, motion):
            return motion if otg.calculate(*legs[0]) in (Result.Working, Result.Finished) else None

    return prepare, call, pick


def sampled(duration, group, at):
    """`at(times, order)` gives derivatives of shape (samples + 1, dof)."""
    import numpy as np

    times = np.linspace(0, duration, group["samples"] + 1)
    return duration, np.stack([at(times, order) for order in range(3)], axis=1)


def toppra(group, cells=None):
    import numpy as np
    import toppra as library
    from toppra.algorithm import TOPPRA
    from toppra.constraint import JointAccelerationConstraint, JointVelocityConstraint

    if group["problem"] != "path_va":
        return None
    logging.disable(logging.CRITICAL)
    v, a, _ = bounds(group)

    def prepare(case):
        points = np.array(case["waypoints"])
        return chord(points), points

    def call(s, points):
        path = library.SplineInterpolator(s, points, bc_type="natural")
        # More cells pay only with the sampler that keeps the acceleration constant in each.
        more = {}
        if cells:
            more = {"gridpoints": np.linspace(0, s[-1], cells + 1), "parametrizer": "ParametrizeConstAccel"}
        limits = [JointVelocityConstraint(v), JointAccelerationConstraint(a)]
        return TOPPRA(limits, path, **more).compute_trajectory(0, 0)

    return prepare, call, lambda motion: motion and sampled(motion.duration, group, motion)


def drake(group):
    """Its spline is made before: it has none with natural ends."""
    import numpy as np
    from pydrake.multibody.optimization import CalcGridPointsOptions, Toppra
    from pydrake.multibody.parsing import Parser
    from pydrake.multibody.plant import MultibodyPlant
    from pydrake.trajectories import PathParameterizedTrajectory, PiecewisePolynomial
    from scipy.interpolate import CubicSpline

    if group["problem"] != "path_va":
        return None
    v, a, _ = bounds(group)
    plant = MultibodyPlant(0)
    Parser(plant).AddModelsFromString(chain(group), "urdf")
    plant.WeldFrames(plant.world_frame(), plant.GetFrameByName("l0"))
    plant.Finalize()

    def prepare(case):
        points = np.array(case["waypoints"])
        s = chord(points)
        tangents = CubicSpline(s, points, bc_type="natural")(s, 1)
        return (PiecewisePolynomial.CubicHermite(s, points.T, tangents.T),)

    def call(path):
        timer = Toppra(path, plant, Toppra.CalcGridPoints(path, CalcGridPointsOptions()))
        timer.AddJointVelocityLimit(-v, v)
        timer.AddJointAccelerationLimit(-a, a)
        scaling = timer.SolvePathParameterization(0, 0)
        return scaling and PathParameterizedTrajectory(path, scaling)

    def pick(motion):
        if motion is None:
            return None
        start = motion.start_time()

        def at(times, order):
            return np.array([motion.EvalDerivative(min(start + t, motion.end_time()), order)[:, 0] for t in times])

        return sampled(motion.end_time() - start, group, at)

    return prepare, call, pick


def roboplan(group, blends=False):
    """Its own spline through the waypoints, or a polyline that passes them within 1e-3 rad."""
    import numpy as np
    from roboplan.core import JointPath, Scene, loadJointLimitsConfig, loadUrdfSceneDescriptionFromXml
    from roboplan.toppra import PathParameterizerTOPPRA, SplineFittingMode, TOPPRAOptions

    if group["problem"] != "path_va":
        return None
    scene = Scene("chain", loadUrdfSceneDescriptionFromXml(chain(group)))
    names = [f"j{i}" for i in range(len(group["limits"]["v"]))]
    with tempfile.NamedTemporaryFile("w", suffix=".yaml", delete=False) as file:
        file.write("joint_limits:\n")
        for name, v, a in zip(names, group["limits"]["v"], group["limits"]["a"]):
            file.write(f"  {name}: {{has_velocity_limits: true, max_velocity: [{v}], ")
            file.write(f"has_acceleration_limits: true, max_acceleration: [{a}]}}\n")
    scene.importJointLimitsFromConfig(loadJointLimitsConfig(file.name))
    os.remove(file.name)
    timer = PathParameterizerTOPPRA(scene)
    how = {"mode": SplineFittingMode.Cubic}
    if blends:
        how = {"mode": SplineFittingMode.LinearBlend, "max_blend_deviation": 1e-3}

    def prepare(case):
        path = JointPath()
        path.joint_names, path.positions = names, [np.array(q) for q in case["waypoints"]]
        return path, TOPPRAOptions(**how)

    def call(path, options):
        return path, timer.generate(path, options)

    def pick(answer):
        path, motion = answer
        # It gives samples only: the same again, with as many of them as are asked for.
        duration = motion.times[-1]
        step = duration / group["samples"] * (1 + 1e-12)
        fine = timer.generate(path, TOPPRAOptions(dt=step, **how))
        values = (fine.positions, fine.velocities, fine.accelerations)
        return duration, np.stack([np.array(rows) for rows in values], axis=1)

    return prepare, call, pick


PEERS = {
    "ruckig": (ruckig, "ruckig"),
    "toppra": (toppra, "toppra"),
    "toppra, 1000 cells": (lambda group: toppra(group, 1000), "toppra"),
    "roboplan": (roboplan, "roboplan"),
    "roboplan, blends": (lambda group: roboplan(group, blends=True), "roboplan"),
    "drake": (drake, "drake"),
}


def run_peer(job, name, maker, row):
    import numpy as np

    rows = []
    for group in job["sets"]:
        made = maker(group)
        if made is None:
            continue
        prepare, call, pick = made
        us, motions = driver.best_times([prepare(case) for case in group["cases"]], job["rounds"], call, pick)
        states = os.path.join(job["folder"], f"{group['name']}_{name}.f64".replace(" ", "_"))
        with open(states, "wb") as file:
            for motion in motions:
                if motion:
                    file.write(np.asarray(motion[1], dtype=np.float64).tobytes())
        durations = [motion[0] if motion else None for motion in motions]
        rows.append(row | {"set": group["name"], "us": us, "durations": durations, "states": states})
    return rows


if __name__ == "__main__":
    driver.start(PEERS, run_peer)
