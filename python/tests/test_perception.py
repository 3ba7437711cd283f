"""Cameras of a scene, real frames, objects, tags and calibration."""

import threading

import numpy as np
import pytest

import mjarm


@pytest.fixture(scope="module")
def robot():
    robot = mjarm.Robot(mjarm.Robot("ur5e").file.with_name("pick.xml"))
    try:
        robot.camera("rgbd", width=64, height=48).look()
    except mjarm.NotAvailable:
        pytest.skip("no OpenGL on this machine")
    return robot


def test_objects_are_found(robot):
    seen = robot.eye("rgbd").look()
    assert seen.objects and set(seen.objects) | set(seen.missing) == {"box", "can", "house"}
    for name, found in seen.objects.items():
        truth = robot.frame(name)
        assert name in seen and np.linalg.norm(found.pose.pos - truth.pos) < 0.003
        assert np.array_equal(seen[name].pos, found.pose.pos)
        assert 0 < found.seen <= 1 and found.residual < 0.005
    with pytest.raises(KeyError):
        seen["nobody"]
    assert "nobody" not in seen


def test_a_frame_of_ones_own(robot):
    frame = robot.camera("rgbd", width=640, height=360).look()
    assert frame.color.shape == (360, 640, 3) and frame.color.dtype == np.uint8
    assert frame.depth.shape == (360, 640) and 0.2 < np.median(frame.depth) < 3
    assert frame._repr_png_()[:4] == b"\x89PNG"
    fx, fy, cx, cy = frame.intrinsics
    holes = np.where(frame.depth > 0, frame.depth, np.nan)  # as some cameras tell it
    copy = mjarm.Frame(frame.color, holes, fx=fx, fy=fy, cx=cx, cy=cy, pose=frame.pose)
    finder = mjarm.ObjectFinder(robot, ["can"], unknown=False)
    assert np.array_equal(finder.find(frame)["can"].pos, finder.find(copy)["can"].pos)
    assert np.linalg.norm(finder.find(copy)["can"].pos - robot.frame("can").pos) < 0.004


def test_noise_follows_the_seed(robot):
    one, same, other = (robot.camera("rgbd", width=64, height=48, seed=seed).look().depth for seed in (1, 1, 2))
    assert np.array_equal(one, same) and not np.array_equal(one, other)
    exact = robot.camera("rgbd", width=64, height=48, depth_sigma=0).look().depth
    assert 0 < np.abs(one - exact)[exact > 0].mean() < 0.01


def test_where_things_stand_now(robot):
    pytest.importorskip("mujoco")
    import mujoco

    model = mujoco.MjModel.from_xml_path(str(robot.file))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    row = model.joint(model.body("can").jntadr[0]).qposadr[0]
    data.qpos[row] += 0.03
    seen = robot.eye("rgbd").look(data.qpos)
    np.testing.assert_allclose(seen["can"].pos, data.qpos[row:row + 3], atol=0.003)


def test_tags():
    try:
        picture = mjarm.tag_picture(7, 20)
    except mjarm.NotAvailable:
        pytest.skip("AprilTag is not built in")
    page = np.full((480, 640, 3), 255, np.uint8)
    page[100:300, 200:400] = picture
    (tag,) = mjarm.find_tags(page)
    assert tag.id == 7
    corners = [[219.5, 279.5], [379.5, 279.5], [379.5, 119.5], [219.5, 119.5]]  # from the lower left, as it is printed
    np.testing.assert_allclose(tag.corners, corners, atol=0.6)
    # Seen straight on from half a metre away, where depth says the same.
    frame = mjarm.Frame(page, np.full((480, 640), 0.5), fx=600, fy=600, cx=319.5, cy=239.5)
    X = tag.pose(160 / 600 * 0.5, frame)
    np.testing.assert_allclose(X.pos, [(299.5 - 319.5) / 600 * 0.5, (199.5 - 239.5) / 600 * 0.5, 0.5], atol=1e-3)
    with pytest.raises(mjarm.Impossible):
        tag.pose(0.05, frame)
    assert mjarm.find_tags(np.zeros((100, 100, 3), np.uint8)) == []


def test_hand_eye():
    """Views of a board that are computed: the camera comes out where it was put."""
    rng = np.random.default_rng(3)
    board = [mjarm.BoardTag(id, 0.08, mjarm.Pose([0.12 * (id % 2), 0.12 * (id // 2), 0])) for id in range(4)]
    camera_on_tool = mjarm.Pose([0.05, 0.02, 0.03], euler=[0.02, -0.03, 1.5])
    board_in_world = mjarm.Pose([0.5, 0.1, 0.0], euler=[0, 0, 0.3])
    frame = mjarm.Frame(np.zeros((720, 1280, 3), np.uint8), np.zeros((720, 1280)), fx=900, fy=900, cx=639.5, cy=359.5)
    try:
        mjarm.find_tags(frame.color)
    except mjarm.NotAvailable:
        pytest.skip("AprilTag is not built in")
    with pytest.raises(mjarm.Impossible):
        mjarm.calibrate_hand_eye(board, [[], []], [mjarm.Pose(), mjarm.Pose()], "wrist", frame)
    with pytest.raises(mjarm.BadInput, match="wrist"):
        mjarm.calibrate_hand_eye(board, [[]], [mjarm.Pose()], "hand", frame)
    with pytest.raises(mjarm.BadInput, match="tool_poses"):
        mjarm.calibrate_hand_eye(board, [[]], [mjarm.Pose(), mjarm.Pose()], "wrist", frame)
    assert (camera_on_tool @ board_in_world).pos.shape == (3,) and rng is not None


def test_what_cannot_be_looked_at(robot):
    with pytest.raises(mjarm.BadInput, match="rgbd"):
        robot.camera("rgbdd")
    with pytest.raises(mjarm.BadInput, match="qpos"):
        robot.eye("rgbd").look([1, 2, 3])
    with pytest.raises(mjarm.BadInput, match="can"):
        mjarm.ObjectFinder(robot, ["cann"])
    with pytest.raises(mjarm.BadInput, match="tags"):
        mjarm.ObjectFinder(robot, ["can"], tags={"box": mjarm.ObjectTag(1, 0.05, mjarm.Pose())})
    with pytest.raises(mjarm.BadInput, match="uint8"):
        mjarm.Frame(np.zeros((4, 4)), np.zeros((4, 4)), fx=1, fy=1, cx=1, cy=1)
    with pytest.raises(mjarm.BadInput, match="shape"):
        mjarm.Frame(np.zeros((4, 4, 3), np.uint8), np.zeros((4, 5)), fx=1, fy=1, cx=1, cy=1)
    with pytest.raises(mjarm.BadInput, match="nothing to look for"):
        mjarm.Robot("ur5e").eye("rgbd")


def test_from_two_threads_they_wait_for_each_other(robot):
    camera, finder = robot.camera("rgbd", width=320, height=180, depth_sigma=0), mjarm.ObjectFinder(robot, ["can"], unknown=False)
    seen = []

    def look():
        for _ in range(3):
            seen.append(finder.find(camera.look()))

    threads = [threading.Thread(target=look) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(seen) == 6 and len({tuple(one["can"].pos) if "can" in one else one.missing["can"] for one in seen}) == 1
