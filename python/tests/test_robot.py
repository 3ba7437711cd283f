"""Robots: files, joints, kinematics; against MuJoCo's own."""

import pickle

import mujoco
import numpy as np
import pytest

import mjarm


@pytest.fixture(scope="module", params=["ur5e", "panda"])
def robot(request):
    return mjarm.Robot(request.param)


def drawn(robot, n, seed=1):
    """Joint values within the limits."""
    rng = np.random.default_rng(seed)
    return rng.uniform(robot.limits.lower, robot.limits.upper, (n, robot.dof))


def test_comes_with_its_figures(robot):
    assert robot.dof == len(robot.joints) == len(robot.home) == len(robot.limits.torque)
    assert (robot.limits.lower < robot.limits.upper).all()
    assert (robot.limits.velocity > 0).all() and (robot.limits.jerk > 0).all()
    assert robot.file.is_file() and robot.timestep == 0.002 and robot.warnings == []
    assert robot.tip in repr(robot)
    assert {"ur5e", "panda"} <= set(mjarm.shipped_models())


def test_fk_is_that_of_mujoco(robot):
    model = mujoco.MjModel.from_xml_path(str(robot.file))
    data = mujoco.MjData(model)
    columns = [model.joint(name).qposadr[0] for name in robot.joints]
    jacobian = np.zeros((6, model.nv))
    for q in drawn(robot, 20):
        data.qpos[columns] = q
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        pose = robot.fk(q)
        np.testing.assert_allclose(pose.pos, data.site(robot.tip).xpos, atol=1e-12)
        np.testing.assert_allclose(pose.rotation.ravel(), data.site(robot.tip).xmat, atol=1e-12)
        np.testing.assert_array_equal(robot.fk(data.qpos).matrix, pose.matrix)
        mujoco.mj_jacSite(model, data, jacobian[:3], jacobian[3:], data.site(robot.tip).id)
        np.testing.assert_allclose(robot.jacobian(q), jacobian[:, columns], atol=1e-12)


def test_many_at_once_are_the_same(robot):
    q = drawn(robot, 200)
    poses = robot.fk_batch(q)
    assert poses.shape == (200, 4, 4)
    np.testing.assert_allclose(poses, [robot.fk(one).matrix for one in q], atol=1e-12)
    values, ok = robot.ik_batch(poses, threads=2)
    assert ok.dtype == bool and ok.all()
    np.testing.assert_allclose(robot.fk_batch(values), poses, atol=1e-6)
    np.testing.assert_array_equal(values, [robot.ik(one).q for one in poses])
    seeded, _ = robot.ik_batch((poses[:, :3, 3], [mjarm.Pose.from_matrix(X).quat for X in poses]), seed=q)
    np.testing.assert_allclose(robot.fk_batch(seeded), poses, atol=1e-6)


def test_ik_goes_to_the_pose_and_stays_near_its_seed(robot):
    for q in drawn(robot, 50, seed=2):
        answer = robot.ik(robot.fk(q), seed=q)
        assert answer.pos_err < 1e-7 and answer.rot_err < 1e-7
        assert np.abs(answer.q - q).max() < 1e-4
        assert (answer.q >= robot.limits.lower).all() and (answer.q <= robot.limits.upper).all()


def test_all_branches_are_answers_and_differ():
    robot = mjarm.Robot("ur5e")
    pose = robot.fk(robot.home)
    answers = robot.ik_all(pose)
    assert len(answers) == 8
    for i, q in enumerate(answers):
        assert robot.fk(q).difference(pose) == pytest.approx((0, 0), abs=1e-7)
        assert all(np.abs(q - other).max() > 0.01 for other in answers[:i])
    assert len(robot.ik_all(pose, windings=True)) > 8


def test_an_answer_can_be_refused_and_what_is_thrown_comes_out():
    robot = mjarm.Robot("ur5e")
    pose = robot.fk(robot.home)
    elsewhere = robot.ik(pose, valid=lambda q: np.abs(q - robot.home).max() > 0.1)
    assert np.abs(elsewhere.q - robot.home).max() > 0.1
    assert elsewhere.pos_err < 1e-7

    def broken(q):
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        robot.ik(pose, valid=broken)
    with pytest.raises(KeyError, match="mine"):
        robot.ik_all(pose, valid=broken)


def test_what_cannot_be_reached_says_why_and_by_how_much():
    robot = mjarm.Robot("ur5e")
    with pytest.raises(mjarm.Unreachable, match="farther than the arm can stretch") as told:
        robot.ik(mjarm.Pose([2, 0, 0.5]))
    failure = told.value
    assert failure.reason is mjarm.IkReason.out_of_reach and failure.joint is None
    assert 0.9 < failure.amount < 1.2
    assert failure.best.pos_err == pytest.approx(failure.amount, abs=0.2)
    with pytest.raises(mjarm.Unreachable) as told:
        robot.ik_all(mjarm.Pose([2, 0, 0.5]))
    assert told.value.reason is mjarm.IkReason.out_of_reach
    values, ok = robot.ik_batch([robot.fk(robot.home), mjarm.Pose([2, 0, 0.5])])
    assert ok.tolist() == [True, False] and np.isnan(values[1]).all()


def test_singularities_have_names():
    robot = mjarm.Robot("ur5e")
    assert robot.singularity(robot.home)[0] is mjarm.SingularKind.none
    straight = robot.home.copy()
    straight[2] = 0
    kind, smallest = robot.singularity(straight)
    assert kind is mjarm.SingularKind.elbow and smallest < 1e-6
    assert robot.manipulability(straight) < 1e-6 < robot.manipulability(robot.home)


@pytest.mark.parametrize(("q", "said"), [
    ([1, 2, 3], r"shape \(6,\)"),
    ([[0] * 6], r"shape \(6,\)"),
    ([90, 0, 0, 0, 0, 0], "angles are in radians"),
    ([np.inf] * 6, "finite"),
    (["1"] * 6, "numbers"),
    ([1j] * 6, "numbers"),
    ([{}] * 6, "numbers"),
])
def test_joint_values_that_are_none(q, said):
    robot = mjarm.Robot("ur5e")
    with pytest.raises(mjarm.BadInput, match=said):
        robot.fk(q)
    with pytest.raises(mjarm.BadInput, match=said):
        robot.ik(robot.fk(robot.home), seed=q)


def test_files_that_are_none():
    with pytest.raises(mjarm.BadInput, match="ur5e"):
        mjarm.Robot("ur5")
    with pytest.raises(mjarm.Error, match="no/such.xml"):
        mjarm.Robot("no/such.xml")
    with pytest.raises(TypeError):
        mjarm.Robot(5)
    with pytest.raises(mjarm.BadInput, match="task"):
        mjarm.Robot("ur5e").ik(mjarm.Pose(), task="sideways")


def test_a_model_that_is_loaded_already(robot):
    model = mujoco.MjModel.from_xml_path(str(robot.file))
    same = mjarm.Robot(model)
    del model  # it was copied
    np.testing.assert_array_equal(same.home, robot.home)
    np.testing.assert_array_equal(same.fk(same.home).matrix, robot.fk(robot.home).matrix)
    assert same.joints == robot.joints and same.tip == robot.tip
    with pytest.raises(mjarm.Error):
        mjarm.Robot(mujoco.MjModel.from_xml_string("<mujoco/>"))


def test_a_model_of_others(tmp_path):
    file = tmp_path / "arm.xml"
    file.write_text("""<mujoco><worldbody><body><joint name="a" axis="0 0 1"/><geom size=".02 .1" type="capsule"/>
      <body pos="0.3 0 0"><joint name="b" axis="0 1 0" range="-2 2"/><geom size=".02 .1" type="capsule"/>
      <site name="tool" pos="0.2 0 0"/></body></body></worldbody></mujoco>""")
    robot = mjarm.Robot(file, tip="tool")
    assert robot.joints == ["a", "b"]
    np.testing.assert_allclose(robot.fk([0, 0]).pos, [0.5, 0, 0], atol=1e-15)
    np.testing.assert_allclose(robot.ik(mjarm.Pose([0, 0.5, 0]), task="position").q[0], np.pi / 2, atol=1e-6)


def test_what_is_no_model_is_refused():
    model = mujoco.MjModel.from_xml_path(str(mjarm.Robot("ur5e").file))

    class Address:
        _address = 0

    for other in (mujoco.MjData(model), mujoco.MjSpec(), Address()):
        with pytest.raises(TypeError):
            mjarm.Robot(other)
    with pytest.raises(mjarm.BadInput, match="another type"):
        mjarm.Robot(b"ur5e")


CART = """
<mujoco>
  <worldbody>
    <body name="cart" pos="0 0 0.1"><freejoint/><geom type="box" size="0.2 0.2 0.1"/>
      <body name="link" pos="0 0 0.2"><joint name="turn" axis="0 0 1" range="-3 3"/>
        <geom type="capsule" fromto="0 0 0 0.3 0 0" size="0.03"/><site name="tcp" pos="0.3 0 0.1"/>
      </body></body>
  </worldbody>
  <keyframe><key name="home" qpos="5 -3 0.1 1 0 0 0  0.5"/></keyframe>
</mujoco>
"""


def test_a_free_base_stands_where_qpos_has_it(tmp_path):
    file = tmp_path / "cart.xml"
    file.write_text(CART)
    robot = mjarm.Robot(file)
    data = mujoco.MjData(mujoco.MjModel.from_xml_path(str(file)))
    data.qpos[:] = [1, 2, 0.3, *mjarm.Pose([0, 0, 0], euler=[0.1, 0.2, 0.9]).quat, 0.7]
    mujoco.mj_forward(data.model, data)
    tool = robot.fk(data.qpos)
    np.testing.assert_allclose(tool.pos, data.site("tcp").xpos, atol=1e-12)
    np.testing.assert_allclose(tool.matrix[:3, :3].ravel(), data.site("tcp").xmat, atol=1e-12)
    jacobian = np.zeros((6, 7))
    mujoco.mj_jacSite(data.model, data, jacobian[:3], jacobian[3:], data.site("tcp").id)
    np.testing.assert_allclose(robot.jacobian(data.qpos)[:, 0], jacobian[:, 6], atol=1e-12)


def test_answers_and_refusals_go_to_other_processes(robot):
    answer = robot.ik(robot.fk(robot.home))
    again = pickle.loads(pickle.dumps(answer))
    np.testing.assert_array_equal(again.q, answer.q)
    assert (again.pos_err, again.rot_err, again.iterations) == (answer.pos_err, answer.rot_err, answer.iterations)
    with pytest.raises(mjarm.Unreachable) as refused:
        robot.ik(mjarm.Pose([5, 0, 0]))
    assert str(pickle.loads(pickle.dumps(refused.value))) == str(refused.value)
