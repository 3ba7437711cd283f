"""Control in a loop of one's own, in the MuJoCo of the package `mujoco`."""

import mujoco
import numpy as np
import pytest

import mjarm


@pytest.fixture
def world():
    model = mujoco.MjModel.from_xml_path(str(mjarm.Robot("ur5e").file))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    return model, data


def test_three_lines_cure_the_sag(world):
    model, data = world
    goal = np.array([-1.0, -1.2, 1.4, -1.6, -1.5, 0.3])
    for _ in range(1500):  # as most scripts do it
        data.ctrl[:6] = goal
        mujoco.mj_step(model, data)
    sag = np.abs(data.qpos[:6] - goal).max()
    assert sag > 1e-3
    controller = mjarm.Robot(model).controller("servo_gravity")  # one
    controller.hold(goal)  # two
    for _ in range(1500):
        controller.step(data)  # three
        mujoco.mj_step(model, data)
    assert np.abs(data.qpos[:6] - goal).max() < sag / 100


def test_a_motion_is_followed(world):
    model, data = world
    robot = mjarm.Robot(model)
    motion = robot.time([robot.home, robot.home + [0.5, -0.3, 0.4, 0, 0.2, 0]])
    controller = robot.controller()
    controller.follow(motion)
    assert not controller.done
    worst, steps = 0, 0
    while not controller.done:
        assert controller.step(data) is False
        mujoco.mj_step(model, data)
        worst = max(worst, np.abs(data.qpos[:6] - controller.reference).max())
        steps += 1
    assert worst < 1e-6
    assert steps * model.opt.timestep == pytest.approx(motion.duration, abs=2 * model.opt.timestep)
    np.testing.assert_allclose(data.qpos[:6], motion.at(motion.duration)[0], atol=1e-6)
    # It is the simulation of robot.simulate().
    np.testing.assert_allclose(robot.simulate(motion, rest=0).log["q"][-1], data.qpos[:6], atol=1e-9)
    for _ in range(200):  # the end is held
        controller.step(data)
        mujoco.mj_step(model, data)
    np.testing.assert_allclose(data.qpos[:6], motion.at(motion.duration)[0], atol=1e-6)


def test_a_world_that_is_put_back_begins_again(world):
    model, data = world
    robot = mjarm.Robot(model)
    motion = robot.time([robot.home, robot.home + 0.3])
    controller = robot.controller()
    controller.follow(motion)
    ends = []
    for _ in range(2):
        mujoco.mj_resetDataKeyframe(model, data, 0)
        for _ in range(round(motion.duration / model.opt.timestep) + 5):
            controller.step(data)
            mujoco.mj_step(model, data)
        ends.append(data.qpos[:6].copy())
    np.testing.assert_array_equal(*ends)
    np.testing.assert_allclose(ends[0], robot.home + 0.3, atol=1e-6)


def test_untold_it_holds_and_leaves_the_rest_alone():
    robot = mjarm.Robot("panda")
    model = mujoco.MjModel.from_xml_path(str(robot.file))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    grip = model.nu - 1
    data.ctrl[grip] = 100
    before = data.qpos[:7].copy()
    controller = robot.controller()
    for _ in range(500):
        controller.step(data)
        mujoco.mj_step(model, data)
    np.testing.assert_allclose(data.qpos[:7], before, atol=1e-6)
    assert data.ctrl[grip] == 100
    assert controller.done


def test_a_load_that_it_does_not_know(world):
    """The controller's model is not the simulation's: the integral takes the error away."""
    model, data = world
    robot = mjarm.Robot(model)
    body = model.nbody - 1
    errors = {}
    for integral in (0.0, 9000.0):
        mujoco.mj_resetDataKeyframe(model, data, 0)
        data.xfrc_applied[body] = [0, 0, -10, 0, 0, 0]  # a kilogram
        controller = robot.controller(integral=integral)
        controller.hold(robot.home)
        for _ in range(3000):
            controller.step(data)
            mujoco.mj_step(model, data)
        errors[integral] = np.abs(data.qpos[:6] - robot.home).max()
    assert errors[9000.0] < 0.01 * errors[0.0] < 0.01


def test_what_is_no_data(world):
    model, data = world
    controller = mjarm.Robot(model).controller()
    for odd in (None, 1, model, np.zeros(6)):
        with pytest.raises(mjarm.BadInput, match="MjData"):
            controller.step(odd)
    other = mujoco.MjModel.from_xml_path(str(mjarm.Robot("panda").file))
    with pytest.raises(mjarm.BadInput, match="another model"):
        controller.step(mujoco.MjData(other))
    with pytest.raises(mjarm.BadInput, match="shape"):
        controller.hold([1, 2])
    with pytest.raises(mjarm.BadInput, match="for 6 joints"):
        ur = mjarm.Robot("ur5e")
        mjarm.Robot("panda").controller().follow(ur.time([ur.home, ur.home + 0.1]))
    with pytest.raises(mjarm.Error):
        mjarm.Robot(model).controller("pid")
    with pytest.raises(mjarm.Error):
        mjarm.Robot(model).controller(stiffness=-1)


def test_robust_control_carries_what_nobody_told_it_of(world):
    model, data = world
    robot = mjarm.Robot(model)
    model.body_mass[mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, "wrist_3_link")] += 1.0
    mujoco.mj_setConst(model, data)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    errors = {}
    for control in ("computed_torque", "robust"):
        mujoco.mj_resetDataKeyframe(model, data, 0)
        controller = robot.controller(control)
        controller.hold(robot.home)
        for _ in range(1000):
            controller.step(data)
            mujoco.mj_step(model, data)
        errors[control] = np.abs(data.qpos[:6] - robot.home).max()
        assert controller.friction.shape == (6,)
    assert errors["robust"] < 1e-5 < errors["computed_torque"]
    with pytest.raises(mjarm.Error):
        robot.controller("robust", late_steps=21)


def test_a_state_that_is_no_number_is_refused(world):
    model, data = world
    controller = mjarm.Robot(model).controller()
    data.qpos[0] = np.nan
    with pytest.raises(mjarm.BadInput, match="finite"):
        controller.step(data)
    assert np.isfinite(data.ctrl).all()
