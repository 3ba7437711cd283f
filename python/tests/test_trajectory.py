"""Motions: what is given in time, within its limits."""

import numpy as np
import pytest

import mjarm


@pytest.fixture(scope="module")
def robot():
    return mjarm.Robot("ur5e")


def expect_within_limits(robot, motion, share=1):
    t, q, v, a = motion.sample(0.002)
    assert t[0] == 0 and t[-1] == motion.duration and (np.diff(t) > 0).all()
    assert q.shape == v.shape == a.shape == (len(t), robot.dof)
    assert (np.abs(v) <= robot.limits.velocity * share * 1.001).all()
    assert (np.abs(a) <= robot.limits.acceleration * share * 1.001).all()
    np.testing.assert_allclose(np.diff(q, axis=0)[:-1] / np.diff(t)[:-1, None], (v[1:] + v[:-1])[:-1] / 2, atol=2e-3)
    np.testing.assert_allclose(v[[0, -1]], 0, atol=1e-9)
    return q


def test_joint_moves(robot):
    goal = robot.home + [1, -0.5, 0.3, 0, 0.2, 0]
    motion = robot.time([robot.home, goal])
    q = expect_within_limits(robot, motion)
    np.testing.assert_allclose(q[0], robot.home)
    np.testing.assert_allclose(q[-1], goal, atol=1e-9)
    slow = robot.time([robot.home, goal], share=0.25)
    assert slow.duration > 1.5 * motion.duration
    expect_within_limits(robot, slow, 0.25)
    for part, whole in zip(motion.at(motion.duration / 2), motion.sample(motion.duration / 2)[1:]):
        np.testing.assert_allclose(part, whole[1])


def test_a_line_at_its_speed(robot):
    begin = robot.fk(robot.home)
    path = robot.line(begin, mjarm.Pose(begin.pos + [0.2, 0, -0.1], quat=begin.quat), robot.home)
    motion = robot.time(path, tool_speed=0.1)
    q = expect_within_limits(robot, motion)
    places = robot.fk_batch(q)[:, :3, 3]
    along = (places - begin.pos) @ ([0.2, 0, -0.1] / np.hypot(0.2, 0.1))
    np.testing.assert_allclose(places, begin.pos + along[:, None] * ([0.2, 0, -0.1] / np.hypot(0.2, 0.1)), atol=1e-4)
    assert (np.linalg.norm(np.diff(places, axis=0), axis=1) / 0.002)[:-1].max() == pytest.approx(0.1, rel=1e-3)


def test_a_plan_stays_free(robot):
    walled = mjarm.Robot(robot.file.with_name("wall.xml"))
    rng = np.random.default_rng(5)
    free = [q for q in rng.uniform(-2.5, 2.5, (40, 6)) if walled.check(q)]
    for start, goal in zip(free[:3], free[3:6]):
        motion = walled.time(walled.plan(start, goal))
        for q in expect_within_limits(walled, motion)[::20]:
            assert walled.check(q, margin=0)


def test_what_cannot_be_timed(robot):
    far = robot.line(robot.fk(robot.home), mjarm.Pose([2, 0, 0.5]), robot.home)
    with pytest.raises(mjarm.Impossible, match="stretch|reach"):
        robot.time(far)
    with pytest.raises(mjarm.BadInput, match="curve"):
        robot.time(robot.follow([robot.fk(robot.home)]))
    for words in ({"share": 0}, {"share": 2}, {"tool_speed": 0}):
        with pytest.raises(mjarm.BadInput):
            robot.time([robot.home, robot.home + 0.1], **words)
    with pytest.raises(mjarm.BadInput, match="shape"):
        robot.time([1, 2, 3])
    motion = robot.time([robot.home, robot.home + 0.1])
    for dt in (0, -1, 1e-12, float("nan")):
        with pytest.raises(mjarm.BadInput, match="dt"):
            motion.sample(dt)


def test_from_state_to_state(robot):
    start = (robot.home, np.full(6, 0.2), np.zeros(6))
    motion = robot.time_between(start, robot.home + 0.4)
    q, v, a = motion.at(0)
    np.testing.assert_allclose(q, robot.home)
    np.testing.assert_allclose(v, 0.2)
    np.testing.assert_allclose(motion.at(motion.duration)[0], robot.home + 0.4, atol=1e-9)
    use = motion.use(robot.limits)
    assert all((use[name] <= 1.001).all() for name in ("velocity", "acceleration")) and not use["position"].any()
    assert max(use["velocity"].max(), use["acceleration"].max(), use["jerk"].max()) > 0.9  # as fast as may be
    rest = robot.time_between(robot.home, robot.home + 0.4)
    assert 0.98 < rest.duration / robot.time([robot.home, robot.home + 0.4]).duration <= 1
    with pytest.raises(mjarm.BadInput, match="shape"):
        robot.time_between((robot.home, [0], [0]), robot.home)
    with pytest.raises(mjarm.BadInput, match="joints"):
        motion.use(mjarm.Robot("panda").limits)


def test_waypoints_without_a_stop(robot):
    waypoints = robot.home + np.array([[0] * 6, [0.3, 0, 0, 0, 0, 0], [0.3, -0.3, 0, 0, 0, 0], [0, -0.3, 0.2, 0, 0, 0]])
    motion, times = robot.time_via(waypoints)
    assert times[0] == 0 and times[-1] == pytest.approx(motion.duration) and (np.diff(times) > 0).all()
    for t, q in zip(times, waypoints):
        np.testing.assert_allclose(motion.at(t)[0], q, atol=1e-7)
    stopping = sum(robot.time([a, b]).duration for a, b in zip(waypoints, waypoints[1:]))
    assert motion.duration < 0.95 * stopping
    assert np.abs(motion.at(times[1])[1]).max() > 0.05


def test_rows_keep_the_joints_in_their_ranges(robot):
    rows = np.array([robot.home] * 4)
    rows[:, 0] = [0, 1, 2, 3]
    rows[:, 2] = [1.57, 3.14, 3.10, 1]  # splines go beyond the second
    for time in (robot.time, robot.time_via):
        with pytest.raises(mjarm.Impossible, match=r"elbow_joint would be 0\.[01].* rad beyond its limits"):
            time(rows)
        with pytest.raises(mjarm.BadInput, match="angles are in radians"):
            time([robot.home, 57 * robot.home])
        time([robot.home, robot.home + 0.3, robot.home - 0.2])
