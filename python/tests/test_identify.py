"""Identification: what logs tell of arms, judged by worlds of MuJoCo that are known."""

import os
import signal
import threading
import time

import mujoco
import numpy as np
import pytest

import mjarm

MASS, CENTER = 1.8, np.array([0.02, -0.01, 0.05])
FRICTION = np.array([3.0, 4.0, 3.0, 0.8, 0.6, 0.5])  # [N m]


@pytest.fixture(scope="module")
def robot():
    return mjarm.Robot("ur5e")


@pytest.fixture(scope="module")
def motion(robot):
    return mjarm.excitation(robot, seconds=10)


def world_of(robot, mass=0.0, forearm=1.0):
    """The arm with a body of that mass at its tool, dry friction in its joints, and a forearm that much heavier."""
    spec = mujoco.MjSpec.from_file(str(robot.file))
    site = spec.site(robot.tip)
    if mass > 0:
        site.parent.add_body(pos=site.pos, quat=site.quat, mass=mass, ipos=CENTER, inertia=[1e-6] * 3, explicitinertial=True)
    spec.body("forearm_link").mass *= forearm
    model = spec.compile()
    model.dof_frictionloss[:6] = FRICTION
    return model


def log_of(robot, motion, model):
    """What MuJoCo itself tells of the motion; the controller does not know what is at the tool."""
    data = mujoco.MjData(model)
    data.qpos[:6] = motion.at(0)[0]
    mujoco.mj_forward(model, data)
    controller = robot.controller("robust")
    controller.follow(motion)
    q, torque = [], []
    while not controller.done:
        controller.step(data)
        mujoco.mj_step(model, data)
        q.append(data.qpos[:6].copy())
        torque.append(data.qfrc_actuator[:6].copy())
    return mjarm.JointLog(model.opt.timestep, q, np.array(torque))


def test_payload_and_friction_of_a_world_of_mujoco(robot, motion):
    log = log_of(robot, motion, world_of(robot, MASS))
    assert len(log) == log.q.shape[0] == log.torque.shape[0] > 4000
    assert "rows of 6 joints, every 0.002 s" in repr(log)
    found = mjarm.identify(robot, log)
    assert float(found.payload.mass) == pytest.approx(MASS, rel=0.05)
    np.testing.assert_allclose([float(one) for one in found.payload.center], CENTER, atol=3e-3)
    assert found.payload.told and 0 < found.payload.mass.error < 0.05
    assert [joint.name for joint in found.joints] == robot.joints
    np.testing.assert_allclose([joint.friction.value for joint in found.joints], FRICTION, rtol=0.05)
    assert all(0 <= joint.unexplained < 0.02 and joint.rms >= 0 for joint in found.joints)
    assert found.links == [] and found.rows > 1000 and abs(found.delay) < 0.01
    assert "kg at (" in repr(found) and "+-" in repr(found.joints[0]) and "+-" in repr(found.payload.mass)


def test_links_that_are_wrong_need_a_log_of_the_empty_arm(robot, motion):
    loaded = log_of(robot, motion, world_of(robot, MASS, forearm=1.3))
    empty = log_of(robot, motion, world_of(robot, forearm=1.3))
    both = mjarm.identify(robot, loaded, empty)
    alone = mjarm.identify(robot, loaded)
    assert both.payload.mass.value == pytest.approx(MASS, rel=0.05)
    assert abs(alone.payload.mass.value - MASS) > 0.05 * MASS
    assert max(joint.unexplained for joint in alone.joints) > max(joint.unexplained for joint in both.joints)
    assert mjarm.identify(robot, loaded, empty=empty, payload=False).payload is not None


def test_links_of_the_model_are_found(robot, motion):
    log = robot.simulate(motion).log
    found = mjarm.identify(robot, mjarm.JointLog(robot.timestep, log["q"], log["torque"]), payload=False, links=True)
    assert found.payload is None and len(found.links) >= 36
    for link in found.links:
        assert link.estimate.known and link.estimate.value == pytest.approx(link.model, abs=5e-3), link
        assert link.name.split()[1] in robot.joints and all(name.split()[1] in robot.joints for name in link.merged)
    assert any(link.merged for link in found.links) and "in the model" in repr(found.links[0])


def test_what_is_found_goes_back_in(robot, motion):
    hung = mjarm.Payload(1.5, [0.01, -0.02, 0.04])
    run = robot.simulate(motion, payload=hung)
    assert run.ok and "1.5000 kg" in repr(hung)
    found = mjarm.identify(robot, mjarm.JointLog(robot.timestep, run.log["q"], run.log["torque"])).payload.value
    assert found.mass == pytest.approx(hung.mass, rel=0.01)
    np.testing.assert_allclose(found.center, hung.center, atol=1e-3)
    assert robot.simulate(motion, payload=found).ok
    program = mjarm.Program.load("movel")
    plain, loaded = program.run().log["torque"], program.run(payload=found).log["torque"]
    assert np.abs(loaded - plain).max() > 5  # [N m]
    assert program.check(payload=found).ok


def test_nothing_at_the_tool(robot, motion):
    log = robot.simulate(motion).log
    found = mjarm.identify(robot, mjarm.JointLog(robot.timestep, log["q"], log["torque"]))
    assert not found.payload.told and abs(found.payload.mass.value) < 1e-3
    assert found.payload.value.mass >= 0 and "no payload" in repr(found)


def test_logs_of_files(robot, motion, tmp_path):
    run = robot.simulate(motion, rest=0)
    run.save(tmp_path / "run")
    log = mjarm.read_joint_log(tmp_path / "run" / "log.csv", robot)
    assert log.timestep == pytest.approx(robot.timestep)
    np.testing.assert_allclose(log.q, run.log["q"], atol=1e-6)
    np.testing.assert_allclose(log.torque, run.log["torque"], atol=1e-4)
    columns = ["time [s]", *(f"torque {name} [N m]" for name in robot.joints), "note", *(f"q {name} [rad]" for name in robot.joints)]
    rows = ["0.1,1,2,3,4,5,6,,.1,.2,.3,.4,.5,.6", "0.104,7,8,9,10,11,12,x,1.1,1.2,1.3,1.4,1.5,1.6"]
    file = tmp_path / "own.csv"
    file.write_text("\n".join([",".join(columns), *rows]) + "\n")
    log = mjarm.read_joint_log(str(file), robot)
    assert log.timestep == pytest.approx(0.004) and log.torque[1, 5] == 12 and log.q[0].tolist() == [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]
    with pytest.raises(mjarm.BadInput, match='no column "q joint1"'):
        mjarm.read_joint_log(file, mjarm.Robot("panda"))
    file.write_text(file.read_text() + "0.2,1\n")
    with pytest.raises(mjarm.BadInput, match="own.csv:4: 2 fields"):
        mjarm.read_joint_log(file, robot)
    with pytest.raises(mjarm.Error, match="nothing.csv"):
        mjarm.read_joint_log(tmp_path / "nothing.csv", robot)


def test_an_excitation_is_free_of_contact_and_comes_back(robot):
    motion = mjarm.excitation(robot, seconds=6, seed=3)
    assert motion.word == "excite" and motion.duration == 6 and motion.dof == 6
    t, q, v, _ = motion.sample(0.02)
    assert all(robot.check(one) for one in q)
    np.testing.assert_allclose([q[0], q[-1]], [robot.home] * 2, atol=1e-9)
    assert np.abs(q - robot.home).max(axis=0).min() > 0.05
    assert (np.abs(v) <= 0.45 * robot.limits.velocity).all()
    np.testing.assert_array_equal(mjarm.excitation(robot, seconds=6, seed=3).at(2.5)[0], motion.at(2.5)[0])
    small = mjarm.excitation(robot, robot.home + 0.1, seconds=6, share=0.1, reach=0.2, collisions=False)
    assert np.abs(small.sample(0.02)[1] - robot.home - 0.1).max() < 0.21
    chance = np.random.default_rng(1)
    hit = next(q for q in chance.uniform(-2, 2, (1000, 6)) if not robot.check(q))
    with pytest.raises(mjarm.Impossible, match="free of contact"):
        mjarm.excitation(robot, hit, seconds=5)


def test_excitations_that_are_none(robot):
    for words, match in [({"seconds": 1}, "5 to 120 s"), ({"seconds": float("nan")}, "5 to 120 s"), ({"share": 0}, "share"),
                         ({"share": 1.5}, "share"), ({"reach": 0}, "reach"), ({"start": [1, 2]}, "start")]:
        with pytest.raises(mjarm.BadInput, match=match):
            mjarm.excitation(robot, **words)


def test_logs_that_are_none(robot):
    rows = np.zeros((5, 6))
    for arguments, match in [((0, rows, rows), "timestep"), ((float("inf"), rows, rows), "timestep"), ((0.002, rows[0], rows), "q: expected shape"),
                             ((0.002, rows, rows[:4]), r"torque: expected shape \(5, 6\), not \(4, 6\)"), ((0.002, rows[:0], rows[:0]), "q"),
                             ((0.002, np.zeros((5, 20)), np.zeros((5, 20))), "1 to 16 joints, not 20"), ((0.002, rows[:, :0], rows[:, :0]), "not 0"),
                             ((0.002, rows, np.full((5, 6), np.nan)), "torque: not every number"), ((0.002, "here", rows), "q: expected numbers")]:
        with pytest.raises(mjarm.BadInput, match=match):
            mjarm.JointLog(*arguments)
    for arguments in ((-1,), (float("nan"),), (1, [0, 0])):
        with pytest.raises(mjarm.BadInput):
            mjarm.Payload(*arguments)


def test_logs_that_tell_nothing(robot):
    def log(rows, dof=6, timestep=0.002, value=0.0):
        return mjarm.JointLog(timestep, np.full((rows, dof), value), np.zeros((rows, dof)))

    still = log(5000)
    for call, match in [(lambda: mjarm.identify(robot, log(100)), "100 rows"), (lambda: mjarm.identify(robot, still), "no joint"),
                        (lambda: mjarm.identify(robot, log(100, timestep=0.1)), "every 0.1 s"),
                        (lambda: mjarm.identify(robot, log(5000, dof=7)), "log: is of 7 joints, the robot has 6"),
                        (lambda: mjarm.identify(robot, still, log(5000, dof=7)), "empty: is of 7 joints"),
                        (lambda: mjarm.identify(robot, still, log(5000, timestep=0.004)), "a row every 0.004 s"),
                        (lambda: mjarm.identify(robot, log(5000, value=-90.0)), "90")]:
        with pytest.raises(mjarm.BadInput, match=match):
            call()
    with pytest.raises(mjarm.Usage, match="payload=False"):
        mjarm.identify(robot, still, links=True)
    with pytest.raises(TypeError):
        mjarm.identify(robot, np.zeros((5, 6)))


def test_ctrl_c_ends_it(robot):
    """A log of a row every 10 us would take minutes."""
    log = mjarm.JointLog(1e-5, np.zeros((300_000, 6)), np.zeros((300_000, 6)))
    begin = time.monotonic()
    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # in the background it is ignored
    try:
        threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
        with pytest.raises(KeyboardInterrupt):
            mjarm.identify(robot, log)
        assert time.monotonic() - begin < 20
    finally:
        signal.signal(signal.SIGINT, before)
