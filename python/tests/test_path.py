"""Curves and the joint values along them."""

import numpy as np
import pytest

import mjarm


@pytest.fixture(scope="module")
def robot():
    return mjarm.Robot("ur5e")


def test_curves_are_walked_by_their_length():
    a, b = mjarm.Pose([0, 0, 0]), mjarm.Pose([0.3, 0.4, 0], euler=[0, 0, 1])
    line = mjarm.Curve.line(a, b)
    assert line.length == pytest.approx(0.5) and line.end == line.length
    assert line.at(0.25).difference(a.interpolate(b, 0.5)) == pytest.approx((0, 0), abs=1e-12)
    assert [pose.pos[0] for pose in line.at([0, 0.5])] == pytest.approx([0, 0.3])
    for s in (0, np.int64(0), np.float32(0), np.array(0.0), 0.0):
        assert line.at(s).difference(a) == pytest.approx((0, 0), abs=1e-12)
    assert len(line.poses(7)) == 7
    circle = mjarm.Curve.ellipse([0, 0, 0.4], 0.1, 0.1)
    assert circle.length == pytest.approx(2 * np.pi * 0.1)
    arc = mjarm.Curve.arc(mjarm.Pose([1, 0, 0]), mjarm.Pose([0, 1, 0]), mjarm.Pose([-1, 0, 0]))
    assert arc.length == pytest.approx(np.pi)
    bent = mjarm.Curve.polyline([a, mjarm.Pose([1, 0, 0]), mjarm.Pose([1, 1, 0])], blend=0.1)
    assert 1.8 < bent.length < 2
    assert mjarm.Curve.spline([a, mjarm.Pose([1, 0, 0]), mjarm.Pose([1, 1, 0])]).length > 2
    with pytest.raises(mjarm.BadInput):
        mjarm.Curve.line(a, a)


def test_a_line_is_followed(robot):
    begin = robot.fk(robot.home)
    end = mjarm.Pose(begin.pos + [0.1, 0, -0.2], quat=begin.quat)
    path = robot.line(begin, end, robot.home)
    assert path.ok and path.fraction == 1 and path.reason is None and path.message == "" and path.fixes == []
    assert path.q.shape == (len(path), 6) and path.s[-1] == pytest.approx(np.hypot(0.1, 0.2))
    np.testing.assert_allclose(path.q[0], robot.home, atol=1e-6)
    for q, s in zip(path.q, path.s):
        assert robot.fk(q).difference(begin.interpolate(end, s / path.s[-1])) == pytest.approx((0, 0), abs=1e-6)
    assert path.max_joint_step < 0.5 and path.clearance > 0.01 and path.limit_room > 0.1
    same = robot.follow(mjarm.Curve.line(begin, end), robot.home)
    np.testing.assert_array_equal(same.q, path.q)


def test_given_poses_are_met_one_by_one(robot):
    poses = robot.fk_batch(robot.home + np.linspace(0, 0.3, 10)[:, None] * [1, 0.5, -0.5, 0, 0, 1])
    path = robot.follow(poses, robot.home, collisions=False)
    assert path.ok and len(path) == 10 and path.s.tolist() == list(range(10)) and path.clearance == np.inf
    np.testing.assert_allclose(robot.fk_batch(path.q), poses, atol=1e-6)


def test_a_path_that_stops_says_why_and_how_to_mend_it(robot):
    theta = np.linspace(0, 2 * np.pi, 100)
    points = np.stack([0.3 * np.cos(theta), -0.3 + 0.15 * np.sin(theta), np.full(100, 0.5)], axis=1)
    far = [mjarm.Pose(p + [0.55, 0, 0], euler=[3.14, 0, 0]) for p in points]
    path = robot.follow(far)
    assert not path.ok and path.reason is mjarm.PathReason.out_of_reach
    assert path.at == 0 and path.fraction == 0 and path.amount > 0
    assert "reach" in path.message or "stretch" in path.message
    fix = path.fixes[0]
    assert fix.kind == "shift" and "shift" in str(fix)
    assert robot.follow([mjarm.Pose(X.pos + fix.shift, quat=X.quat) for X in far]).ok


@pytest.mark.parametrize("words", [
    {"max_step": 0}, {"max_step": 4}, {"orientation_tol": -1}, {"orientation_tol": 2}, {"tool_speed": -1},
    {"start": [0] * 5}, {"start": [100] * 6}])
def test_what_is_no_way_to_follow(robot, words):
    with pytest.raises(mjarm.BadInput):
        robot.line(robot.fk(robot.home), mjarm.Pose([0.1, 0.5, 0.5]), **words)


def test_a_spline_keeps_the_corners_it_is_asked_to():
    poses = [[0, 0, 0], [0.2, 0, 0], [0.4, 0.1, 0], [0.3, 0.3, 0], [0.3, 0.5, 0]]
    poses = [mjarm.Pose(p) for p in poses]
    smooth, kept = mjarm.Curve.spline(poses), mjarm.Curve.spline(poses, corner=1.0)
    parts = mjarm.Curve.spline(poses[:3]).length + mjarm.Curve.spline(poses[2:]).length
    assert kept.length == pytest.approx(parts, abs=1e-12)
    assert abs(smooth.length - kept.length) > 1e-4
