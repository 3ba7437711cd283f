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


def looking_at(target, eye):
    """A camera at `eye`: x to the right, y down, z towards the target."""
    z = (target - eye) / np.linalg.norm(target - eye)
    x = np.cross(z, [0.2, 1, 0])
    x /= np.linalg.norm(x)
    return mjarm.Pose(eye, matrix=np.stack([x, np.cross(z, x), z], axis=1))


def picture_of(board, tags, X_BC, fx, cx, cy):
    """What a camera sees of a white board with tags on it, ray by ray."""
    v, u = np.mgrid[0:720, 0:1280]
    rays = np.stack([(u - cx) / fx, (v - cy) / fx, np.ones_like(u)], axis=-1) @ X_BC.matrix[:3, :3].T
    points = X_BC.pos + rays * (-X_BC.pos[2] / rays[..., 2])[..., None]
    image = np.full((720, 1280, 3), 255, np.uint8)
    for place, tag in zip(board, tags):
        x, y = points[..., 0] - place[0], points[..., 1] - place[1]
        on = (abs(x) < 0.0499) & (abs(y) < 0.0499)
        image[on] = tag[((0.05 - y[on]) / 0.1 * len(tag)).astype(int), ((x[on] + 0.05) / 0.1 * len(tag)).astype(int)]
    return image


def test_hand_eye():
    """Views of a board that are computed: the camera comes out where it was put."""
    camera_on_tool = mjarm.Pose([0.05, 0.02, 0.03], euler=[0.02, -0.03, 1.5])
    board_in_world = mjarm.Pose([0.5, 0.1, 0.0], euler=[0, 0, 0.3])
    places = [np.array([0.12 * (i % 2), 0.12 * (i // 2), 0]) for i in range(4)]
    board = [mjarm.BoardTag(i, 0.08, mjarm.Pose(place)) for i, place in enumerate(places)]
    frame = mjarm.Frame(np.zeros((720, 1280, 3), np.uint8), np.zeros((720, 1280)), fx=900, fy=900, cx=639.5, cy=359.5)
    try:
        tags = [mjarm.tag_picture(i, 20) for i in range(4)]
    except mjarm.NotAvailable:
        pytest.skip("AprilTag is not built in")
    seen, tools = [], []
    for eye in ([0.06, 0.06, 0.5], [0.3, 0, 0.4], [-0.2, 0.1, 0.45], [0, 0.3, 0.4], [0.1, -0.25, 0.5]):
        X_BC = looking_at(np.array([0.06, 0.06, 0]), np.array(eye))
        seen.append(mjarm.find_tags(picture_of(places, tags, X_BC, 900, 639.5, 359.5)))
        tools.append(board_in_world @ X_BC @ camera_on_tool.inverse())
    found = mjarm.calibrate_hand_eye(board, seen, tools, "wrist", frame)
    assert found.views == 5 and found.residual < 1
    for one, wanted in ((found.camera, camera_on_tool), (found.board, board_in_world)):
        off = one.difference(wanted)
        assert off[0] < 0.003 and off[1] < 0.006, off
    with pytest.raises(mjarm.Impossible):
        mjarm.calibrate_hand_eye(board, [[], []], tools[:2], "wrist", frame)
    with pytest.raises(mjarm.BadInput, match="wrist"):
        mjarm.calibrate_hand_eye(board, seen, tools, "hand", frame)
    with pytest.raises(mjarm.BadInput, match="tool_poses"):
        mjarm.calibrate_hand_eye(board, seen, tools[:2], "wrist", frame)


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
