"""Poses: what goes in, what comes out, and what is refused."""

import pickle

import numpy as np
import pytest

import mjarm


def test_every_way_to_say_one_rotation():
    quat = [np.cos(0.4), 0, 0, np.sin(0.4)]
    turn = np.array([[np.cos(0.8), -np.sin(0.8), 0], [np.sin(0.8), np.cos(0.8), 0], [0, 0, 1]])
    whole = np.eye(4)
    whole[:3, :3], whole[:3, 3] = turn, [1, 2, 3]
    poses = [mjarm.Pose([1, 2, 3], euler=[0, 0, 0.8]), mjarm.Pose([1, 2, 3], quat=quat),
             mjarm.Pose((1, 2, 3), matrix=turn), mjarm.Pose.from_matrix(whole)]
    for pose in poses:
        assert pose.difference(poses[0]) == pytest.approx((0, 0), abs=1e-12)
        np.testing.assert_allclose(pose.matrix, whole, atol=1e-12)
        np.testing.assert_allclose(pose.quat, quat, atol=1e-12)
        np.testing.assert_allclose(pose.euler, [0, 0, 0.8], atol=1e-12)
        np.testing.assert_allclose(pose.rotation, turn, atol=1e-12)
        np.testing.assert_allclose(np.asarray(pose), whole, atol=1e-12)


def test_euler_angles_are_about_fixed_axes():
    rotation = mjarm.Pose(euler=[0.3, -0.2, 1.1]).rotation

    def about(axis, angle):
        i, j = (axis + 1) % 3, (axis + 2) % 3
        turn = np.eye(3)
        turn[i, i] = turn[j, j] = np.cos(angle)
        turn[j, i], turn[i, j] = np.sin(angle), -np.sin(angle)
        return turn

    np.testing.assert_allclose(rotation, about(2, 1.1) @ about(1, -0.2) @ about(0, 0.3), atol=1e-15)


def test_products_inverses_and_points():
    rng = np.random.default_rng(1)
    a, b = (mjarm.Pose(rng.normal(size=3), euler=rng.uniform(-3, 3, 3)) for _ in range(2))
    np.testing.assert_allclose((a @ b).matrix, a.matrix @ b.matrix, atol=1e-12)
    np.testing.assert_allclose(a.inverse().matrix, np.linalg.inv(a.matrix), atol=1e-12)
    points = rng.normal(size=(5, 3))
    np.testing.assert_allclose(a @ points, points @ a.rotation.T + a.pos, atol=1e-12)
    np.testing.assert_allclose(a @ points[0], (a @ points)[0])
    half = a.interpolate(b, 0.5)
    np.testing.assert_allclose(half.pos, (a.pos + b.pos) / 2, atol=1e-12)
    assert half.difference(a)[1] == pytest.approx(half.difference(b)[1])


def test_survives_pickling_and_shows_itself():
    pose = mjarm.Pose([0.1, -0.2, 0.3], euler=[0.1, 0.2, 0.3])
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(pose)).matrix, pose.matrix)
    assert repr(pose).startswith("Pose([0.1, -0.2, 0.3], quat=[")


@pytest.mark.parametrize(("words", "said"), [
    ({"pos": [1, 2]}, r"pos: expected shape \(3,\), not \(2,\)"),
    ({"pos": "here"}, "pos: expected numbers, not str"),
    ({"pos": [1, 2, np.nan]}, "pos: not every number is finite"),
    ({"euler": [180, 0, 90]}, "rad, not degrees"),
    ({"quat": [0, 0, 0, 0]}, "not zeros"),
    ({"matrix": np.ones((3, 3))}, "rotation matrix"),
    ({"matrix": np.diag([1, 1, -1])}, "rotation matrix"),
    ({"euler": [0, 0, 0], "quat": [1, 0, 0, 0]}, "one of euler, quat and matrix"),
])
def test_what_is_no_pose_is_told(words, said):
    with pytest.raises(mjarm.BadInput, match=said):
        mjarm.Pose(**words)
    with pytest.raises(ValueError):  # as Python's own
        mjarm.Pose(**words)
