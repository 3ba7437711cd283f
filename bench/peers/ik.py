"""Runs other inverse-kinematics libraries on the cases of `mjarm bench ik`.

Usage: ik.py JOB.json ANSWERS.jsonl (mjarm calls it). Each peer runs in a process of its own, so that
none can disturb another, in one thread. The clock stands right around the library's own call:
targets are converted before, answers are unpacked after. Whether an answer is right is judged by
mjarm, with MuJoCo's forward kinematics.
"""

import os
import subprocess
import sys
import xml.etree.ElementTree

import driver


def matrix(pose):
    import numpy as np

    w, x, y, z = pose["quat"]
    target = np.eye(4)
    target[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    target[:3, 3] = pose["pos"]
    return target


def root_link(urdf):
    robot = xml.etree.ElementTree.parse(urdf).getroot()
    children = {joint.find("child").get("link") for joint in robot.iter("joint") if joint.find("child") is not None}
    return next(link.get("name") for link in robot.findall("link") if link.get("name") not in children)


def chain_only(job):
    """Path of a URDF with nothing but the way from the root to the tip."""
    tree = xml.etree.ElementTree.parse(job["urdf"])
    robot = tree.getroot()
    above = {j.find("child").get("link"): j for j in robot.findall("joint") if j.find("child") is not None}
    links, joints = {job["tip"]}, []
    link = job["tip"]
    while link in above:
        joints.append(above[link])
        link = above[link].find("parent").get("link")
        links.add(link)
    for element in list(robot):
        if element not in joints and not (element.tag == "link" and element.get("name") in links):
            robot.remove(element)
    path = os.path.join(job["folder"], "chain.urdf")
    tree.write(path)
    return path


def within(q, job):
    return all(lower - 1e-9 <= v <= upper + 1e-9 for v, lower, upper in zip(q, job["lower"], job["upper"]))


# Each maker takes the job and gives three functions: prepare(case) -> arguments, call(*arguments) ->
# whatever the library returns, which is timed, and pick(that) -> joint values, or None for "no".


def eaik(job):
    import numpy as np
    from eaik.IK_URDF import UrdfRobot

    robot = UrdfRobot(job["urdf"])
    if not robot.hasKnownDecomposition() or len(job["joints"]) != 6:
        raise NotImplementedError("no closed form for this arm")
    # Its end effector is another frame of the last link.
    to_tip = np.linalg.inv(matrix(job["zero"])) @ robot.fwdKin(np.zeros(6))

    def pick(answer):
        for q, least_squares in zip(answer.Q, answer.is_LS):
            if not least_squares and within(q, job):
                return q
        return None

    return lambda case: (matrix(case) @ to_tip,), robot._robot.calculate_IK, pick


def ssik_module(job):
    # Its build tool writes a module for the arm, which calls compiled code.
    path = os.path.join(job["folder"], "peer_arm_ik.py")
    command = [os.path.join(os.path.dirname(sys.executable), "ssik"), "build", job["urdf"], "--no-validate"]
    command += ["--base", root_link(job["urdf"]), "--ee", job["tip"], "--out", path]
    subprocess.run(command, check=True, capture_output=True)
    sys.path.insert(0, job["folder"])
    import peer_arm_ik

    return peer_arm_ik


def ssik(job):
    import numpy as np

    module = ssik_module(job)

    def call(target, seed):
        return module.solve(target, max_solutions=1, q_seed=seed, enumerate_windings=False)

    return lambda case: (matrix(case), np.array(case["seed"])), call, lambda found: found[0].q if found else None


def roboticstoolbox(job):
    import numpy as np
    from roboticstoolbox import Robot

    chain = Robot.URDF(job["urdf"]).ets(end=job["tip"])

    def call(target, seed):
        return chain.ik_LM(target, q0=seed)

    return lambda case: (matrix(case), np.array(case["seed"])), call, lambda a: a.q if a.success else None


def pytracik(job):
    import numpy as np
    import pytracik as library
    from trac_ik import TracIK

    # It stops by the clock; with its default of 5 ms a busy machine would make it fail.
    solver = TracIK(root_link(job["urdf"]), job["tip"], job["urdf"], timeout=0.05)._ik_solver

    def prepare(case):
        w, x, y, z = case["quat"]
        return solver, np.array(case["seed"]), *case["pos"], x, y, z, w

    return prepare, library.ik, lambda answer: answer[1:] if answer[0] >= 0 else None


def ikpy(job):
    import numpy as np
    from ikpy.chain import Chain

    # It follows the first child of every link, which need not lead to the tip.
    chain = Chain.from_urdf_file(chain_only(job), base_elements=[root_link(job["urdf"])])
    names = [link.name for link in chain.links]
    at = [names.index(joint) for joint in job["joints"]]
    chain.active_links_mask[:] = [i in at for i in range(len(names))]

    def prepare(case):
        start = np.zeros(len(names))
        start[at] = case["seed"]
        return matrix(case), start

    def call(target, start):
        return chain.inverse_kinematics_frame(target, initial_position=start, orientation_mode="all")

    # It never says no; what it gives is always an answer.
    return prepare, call, lambda q: q[at]


def pinocchio(job):
    import numpy as np
    import pinocchio as pin

    model = pin.buildModelFromUrdf(job["urdf"])
    data = model.createData()
    tip = model.getFrameId(job["tip"])
    local = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
    joints = [model.joints[model.getJointId(name)] for name in job["joints"]]

    def prepare(values):
        q = pin.neutral(model)
        for joint, value in zip(joints, values):
            q[joint.idx_q : joint.idx_q + joint.nq] = [value] if joint.nq == 1 else [np.cos(value), np.sin(value)]
        return (q,)

    return prepare, lambda q: pin.computeFrameJacobian(model, data, q, tip, local), lambda J: None


PEERS = {
    "EAIK": (eaik, "eaik"),
    "ssik": (ssik, "ssik"),
    "roboticstoolbox": (roboticstoolbox, "roboticstoolbox-python"),
    "TRAC-IK": (pytracik, "pytracik"),
    "ikpy": (ikpy, "ikpy"),
    "pinocchio": (pinocchio, "pin"),
}


def run_mean(cases, rounds, prepare, call):
    arguments = [prepare(case) for case in cases]

    def work():
        for words in arguments:
            call(*words)

    return driver.best_mean(rounds, len(arguments), work)


def run_peer(job, name, maker, row):
    prepare, call, pick = maker(job)
    if name == "pinocchio":
        return [row | {"set": "fk_jacobian", "us": run_mean(job["fk"], job["rounds"], prepare, call)}]
    rows = []
    for group in job["sets"]:
        us, answers = driver.best_times([prepare(case) for case in group["cases"]], job["rounds"], call, pick)
        q = [None if values is None else [float(v) for v in values] for values in answers]
        rows.append(row | {"set": group["name"], "us": us, "q": q})
    return rows


if __name__ == "__main__":
    driver.start(PEERS, run_peer)
