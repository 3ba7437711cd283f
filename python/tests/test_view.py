"""The window beside a loop of one's own; where there is no display, it says so."""

import multiprocessing
import os
import time

import mujoco
import numpy as np
import pytest

import mjarm


@pytest.fixture
def world():
    robot = mjarm.Robot("ur5e")
    model = mujoco.MjModel.from_xml_path(str(robot.file))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    return robot, model, data


def open_window(robot, **words):
    if not os.environ.get("DISPLAY"):
        pytest.skip("no display")
    return mjarm.view(robot, **words)


def test_it_shows_a_loop_in_real_time(world):
    robot, model, data = world
    with open_window(robot) as window:
        window.add_path(mjarm.Curve.ellipse([0, -0.5, 0.4], 0.2, 0.1, euler=[3.14, 0, 0]))
        assert window.is_open
        for _ in range(50):  # the first frames take their time
            window.sync(data)
        begin = time.monotonic()
        for _ in range(250):
            mujoco.mj_step(model, data)
            assert window.sync(data)
        taken = time.monotonic() - begin
        assert taken > 0.4 * 250 * model.opt.timestep
    assert not window.is_open
    assert window.sync(data) is False
    window.close()


def test_one_after_another_and_without_a_pace(world):
    robot, _, data = world
    for _ in range(2):
        window = open_window(robot, real_time=False, trail=False, title="loop")
        begin = time.monotonic()
        for _ in range(1000):
            window.sync(data.qpos)
        assert time.monotonic() - begin < 20
        window.close()
    with open_window(robot) as window, pytest.raises(mjarm.BadInput, match="qpos"):
        window.sync(np.zeros(3))


def test_without_a_display_it_says_so(world):
    kept = {name: os.environ.pop(name, None) for name in ("DISPLAY", "WAYLAND_DISPLAY")}
    try:
        with pytest.raises(mjarm.NotAvailable, match="display"):
            mjarm.view(world[0])
    finally:
        os.environ.update({name: value for name, value in kept.items() if value is not None})


def draw(_):
    try:
        return len(mjarm.Robot("ur5e").picture(width=32, height=32))
    except mjarm.NotAvailable as why:
        return str(why)


def test_a_copy_of_a_process_that_has_drawn_says_why_it_cannot():
    drawn = draw(0)
    if isinstance(drawn, str):
        pytest.skip(drawn)
    with multiprocessing.get_context("fork").Pool(1) as pool:
        assert "spawn" in pool.map_async(draw, [1]).get(timeout=60)[0]
