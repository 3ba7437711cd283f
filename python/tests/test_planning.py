"""Contacts and plans; judged by MuJoCo in Python."""

import os
import signal
import threading
import time

import mujoco
import numpy as np
import pytest

import mjarm



@pytest.fixture(scope="module")
def robot():
    return mjarm.Robot("ur5e")


def touches(robot, model, q):
    """By MuJoCo: contacts deeper than a hundredth of a millimetre."""
    data = mujoco.MjData(model)
    data.qpos[:] = model.key_qpos[0] if model.nkey else model.qpos0
    data.qpos[[model.joint(name).qposadr[0] for name in robot.joints]] = q
    mujoco.mj_forward(model, data)
    return [c.dist for c in data.contact if c.dist < -1e-5]


def test_contacts_are_those_of_mujoco(robot):
    model = mujoco.MjModel.from_xml_path(str(robot.file))
    rng = np.random.default_rng(3)
    hits = 0
    for _ in range(200):
        q = rng.uniform(-3, 3, 6)
        report = robot.check(q)
        assert bool(report) == report.free == (not touches(robot, model, q))
        if not report:
            hits += 1
            contact = report.contacts[0]
            assert contact.depth > 0 and len(contact.geoms) == 2 and len(contact.bodies) == 2
            assert np.linalg.norm(contact.normal) == pytest.approx(1)
    assert 20 < hits < 180
    at_home = robot.check(robot.home, margin=0.3)
    assert at_home.free and 0 < at_home.distance < 0.3 and len(at_home.nearest) == 2
    assert robot.check(robot.home, margin=0).nearest is None


def test_a_plan_goes_round_what_is_in_the_way(robot):
    scene = robot.file.with_name("wall.xml")
    walled = mjarm.Robot(scene)
    model = mujoco.MjModel.from_xml_path(str(scene))
    rng = np.random.default_rng(5)
    free = [q for q in rng.uniform(-2.5, 2.5, (60, 6)) if walled.check(q)]
    for start, goal in zip(free[:6], free[6:12]):
        plan = walled.plan(start, goal)
        np.testing.assert_array_equal(plan.path[0], start)
        np.testing.assert_array_equal(plan.path[-1], goal)
        assert plan.length == pytest.approx(np.linalg.norm(np.diff(plan.path, axis=0), axis=1).sum())
        assert len(plan.certificate) == len(plan) - 1
        for edge in plan.certificate:
            assert edge[0, 0] - edge[0, 1] <= 0 and edge[-1, 0] + edge[-1, 1] >= 1
            assert (edge[1:, 0] - edge[1:, 1] <= edge[:-1, 0] + edge[:-1, 1] + 1e-12).all()
        for a, b in zip(plan.path, plan.path[1:]):
            for t in np.linspace(0, 1, 40):
                assert not touches(walled, model, a + t * (b - a))
        assert walled.verify(plan) == []
        np.testing.assert_array_equal(walled.plan(start, goal).path, plan.path)  # the same again


def test_goals_may_be_poses_or_many(robot):
    pose = robot.fk(robot.home + [0.5, 0.2, -0.3, 0, 0, 0])
    plan = robot.plan(None, pose)
    assert robot.fk(plan.path[-1]).difference(pose) == pytest.approx((0, 0), abs=1e-6)
    np.testing.assert_array_equal(plan.path[0], robot.home)
    assert robot.plan(None, pose.matrix).length == plan.length
    several = robot.plan(None, robot.ik_all(pose))
    assert several.length <= plan.length + 1e-6
    assert robot.plan(None, [mjarm.Pose([9, 9, 9]), pose]).length == pytest.approx(plan.length, abs=1e-6)


def test_upright_is_kept(robot):
    goal = robot.home + [1.5, 0, 0, 0, 0, 0]
    plan = robot.plan(None, goal, upright=0.1)
    up = robot.fk(robot.home).rotation.T @ [0, 0, 1]
    for a, b in zip(plan.path, plan.path[1:]):
        for t in np.linspace(0, 1, 20):
            assert np.arccos(np.clip((robot.fk(a + t * (b - a)).rotation @ up)[2], -1, 1)) < 0.1 + 1e-6


def test_what_has_no_plan_says_why(robot):
    inside = robot.home.copy()
    inside[1] = 0.6  # into the floor
    assert not robot.check(inside)
    with pytest.raises(mjarm.NoPath) as told:
        robot.plan(None, inside)
    assert told.value.reason is mjarm.PlanReason.goals_hit
    with pytest.raises(mjarm.NoPath) as told:
        robot.plan(inside, robot.home)
    assert told.value.reason is mjarm.PlanReason.start_hit
    with pytest.raises(mjarm.Unreachable):
        robot.plan(None, mjarm.Pose([5, 0, 0]))
    with pytest.raises(mjarm.BadInput, match="nothing"):
        robot.plan(None, robot.home, held=["nothing"])
    for words in ({"samples": -1}, {"time_limit": -1.0}, {"qpos": [0]}, {"margin": -1.0}):
        with pytest.raises(mjarm.BadInput):
            robot.plan(None, robot.home + 0.1, **words)


def test_ctrl_c_ends_a_search(robot):
    """The signal's handler throws, and the search gives up at once."""
    scene = robot.file.with_name("wall.xml")
    walled = mjarm.Robot(scene)
    goal = walled.home + [0.4, 0, 0, 0, 0, 0]
    begin = time.monotonic()
    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # in the background it is ignored
    try:
        threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
        with pytest.raises(KeyboardInterrupt):
            while time.monotonic() - begin < 60:  # rounds that go on for minutes
                walled.plan(None, goal, rounds=10_000_000, time_limit=0)
        assert time.monotonic() - begin < 20
    finally:
        signal.signal(signal.SIGINT, before)


def test_threads_plan_at_the_same_time(robot):
    goal = robot.home + [0.8, 0.3, -0.3, 0, 0, 0]
    alone = robot.plan(None, goal).path
    answers = [None] * 4

    def work(i):
        answers[i] = robot.plan(None, goal).path

    threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for path in answers:
        np.testing.assert_array_equal(path, alone)


def test_regions(robot):
    down = mjarm.Pose([0.3, -0.45, 0.3], euler=[np.pi, 0, 0])
    region = mjarm.Region(down, half=[0.05, 0.05, 0.02], turn=np.pi)
    assert np.allclose(region.middle.pos, down.pos) and region.room(down) == (0.02, pytest.approx(0, abs=1e-9))
    goal = robot.plan(robot.home, region)
    end = robot.fk(goal.path[-1])
    assert (np.abs(end.pos - down.pos) <= [0.0501, 0.0501, 0.0201]).all()
    assert (end @ mjarm.Pose([0, 0, 1])).pos[2] < end.pos[2] - 0.999  # the tool points down
    exact = robot.plan(robot.home, down)
    assert goal.length <= exact.length + 1e-9
    far = mjarm.Pose(down.pos + [0, 0, 0.5], quat=down.quat)
    assert region.room(far)[0] < 0 and region.room(region.nearest(far))[0] >= -1e-9
    # It stays at its height all the way.
    level = mjarm.Region.bounds(mjarm.Pose([0, 0, 0.3]), place_min=[-np.inf, -np.inf, -0.05], place_max=[np.inf, np.inf, 0.05],
                                turn_min=[-np.pi, -np.pi / 2, -np.pi], turn_max=[np.pi, np.pi / 2, np.pi])
    start = robot.ik(down).q
    held = robot.plan(start, mjarm.Pose([-0.3, -0.45, 0.3], euler=[np.pi, 0, 0]), within=level)
    for a, b in zip(held.path, held.path[1:]):
        for t in np.linspace(0, 1, 20):
            assert abs(robot.fk(a + t * (b - a)).pos[2] - 0.3) <= 0.0501
    # A door that stands where its handle is, with room for the hand to turn in it; a drawer.
    handle = mjarm.Region(down, half=[0.01, 0.01, 0.01], lean=0.05, turn=0.5)
    door = handle.on_hinge([0.6, -0.45, 0], [0, 0, 2], 0, 1.2)
    held = door.standing_at(0.4).middle
    assert np.linalg.norm(held.pos - [0.6, -0.45, 0.3]) == pytest.approx(0.3)
    assert door.value(held) == pytest.approx(0.4) and min(door.room(held)) > 0 > handle.room(held)[0]
    turned = held @ mjarm.Pose([0, 0, 0], euler=[0, 0, 0.4])
    assert door.value(turned) == pytest.approx(0.4) and door.room(turned)[1] > 0
    drawer = handle.on_slide([0, -1, 0], 0, 0.2)
    pulled = mjarm.Pose([0.3, -0.6, 0.3], quat=down.quat)
    assert drawer.value(pulled) == pytest.approx(0.15) and handle.value(pulled) == 0
    for axis, most in (([0, 0, 0], 1), ([0, 0, 1], -1), ([0, 0, 1], 7)):
        with pytest.raises(mjarm.BadInput, match="Region"):
            handle.on_hinge([0, 0, 0], axis, 0, most)
    for words in ({"half": [-1, 0, 0]}, {"lean": 4}, {"turn": -1}):
        with pytest.raises(mjarm.BadInput, match="Region"):
            mjarm.Region(down, **words)
    with pytest.raises(mjarm.BadInput, match="half"):
        mjarm.Region(down, half=[1, 2])
