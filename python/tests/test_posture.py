"""Branches, freedom left over, workspaces, servoing, and how two arms differ."""

import numpy as np
import pytest

import mjarm


@pytest.fixture(scope="module")
def robot():
    return mjarm.Robot("ur5e")


@pytest.fixture(scope="module")
def panda():
    return mjarm.Robot("panda")


def test_branches(robot):
    Q = robot.ik_all(mjarm.Pose([-0.13, 0.6, 0.1], euler=[3.14, 0, 1.57]))
    words = {robot.branch(q) for q in Q}
    assert len(words) == len(Q) == 8  # each answer is another branch
    assert all(word.startswith("shoulder=") and "elbow=" in word and "wrist=" in word for word in words)


def test_the_freedom_of_seven_axes(panda):
    rng = np.random.default_rng(1)
    middle = (panda.limits.lower + panda.limits.upper) / 2
    for _ in range(5):
        q = rng.uniform(panda.limits.lower + 0.3, panda.limits.upper - 0.3)
        X = panda.fk(q)
        moved = panda.null_space(X, q, "manipulability").q
        assert panda.manipulability(moved) >= panda.manipulability(q)
        np.testing.assert_allclose(panda.fk(moved).difference(X), 0, atol=1e-6)
        central = panda.null_space(X, q).q
        room = lambda q: (((q - middle) / (panda.limits.upper - panda.limits.lower)) ** 2).sum()
        assert room(central) <= room(q) + 1e-9
        near = panda.null_space(X, q, "near_posture").q
        assert np.linalg.norm(near - panda.home) <= np.linalg.norm(q - panda.home) + 1e-9
    with pytest.raises(mjarm.BadInput, match="near_posture"):
        panda.null_space(X, q, "nearest")
    with pytest.raises(mjarm.BadInput):
        panda.null_space(mjarm.Pose([0.5, 0, 0.5]), q)


def test_ellipsoid_against_numpy(robot):
    for q in (robot.home, robot.home + 0.3):
        axes, semi = robot.ellipsoid(q)
        u, s, _ = np.linalg.svd(robot.jacobian(q)[:3])
        np.testing.assert_allclose(semi, s, atol=1e-9)
        np.testing.assert_allclose(np.abs(axes.T @ u), np.eye(3), atol=1e-6)


def test_workspace(robot):
    space = robot.workspace("z", at=0.4, step=0.1, orientation=mjarm.Pose(euler=[np.pi, 0, 0]))
    assert space.branches.shape == space.manipulability.shape == (len(space.v), len(space.u)) and space.counted
    assert np.array_equal(space.branches == 0, np.isnan(space.manipulability))
    row, column = np.unravel_index(np.nanargmax(space.branches), space.branches.shape)
    X = mjarm.Pose([space.u[column], space.v[row], 0.4], euler=[np.pi, 0, 0])
    assert len(robot.ik_all(X)) == space.branches[row, column]
    with pytest.raises(mjarm.BadInput, match="x, y or z"):
        robot.workspace("w")
    with pytest.raises(mjarm.Error):
        robot.workspace(step=0)


def test_two_descriptions_of_one_arm(robot):
    same = robot.compare(robot)
    assert same.position == 0 and same.causes == []
    urdf = robot.compare(mjarm.Robot(robot.file.with_name("ur5e.urdf")))  # it stands turned, and with another tool frame
    assert urdf.position > 1 and set(urdf.causes) <= {"base", "tool", "zero_offset"} and urdf.position_left < 1e-6
    with pytest.raises(mjarm.Impossible):
        robot.compare(mjarm.Robot("panda"))


def test_a_tool_is_led(robot):
    tracker = robot.tracker(dt=0.01)
    q, target = robot.home, robot.fk(robot.home)
    for _ in range(100):
        target = mjarm.Pose(target.pos - [0, 0, 0.001], quat=target.quat)
        step = tracker.step(target, q)
        assert (np.abs(step.q - q) <= robot.limits.velocity * 0.01 + 1e-12).all()
        q = step.q
    assert np.linalg.norm(robot.fk(q).pos - target.pos) < 1e-3
    for words in ({"dt": 0}, {"gain": 2}, {"speed_share": 0}):
        with pytest.raises(mjarm.BadInput):
            robot.tracker(**words)
    with pytest.raises(mjarm.BadInput, match="shape"):
        tracker.step(target, [0, 0])


def test_what_is_not_at_the_pose_is_told_by_how_much(robot):
    with pytest.raises(mjarm.BadInput, match="its tool is .* m and .* rad from the pose"):
        robot.null_space(robot.fk(robot.home), robot.home + 0.5)
