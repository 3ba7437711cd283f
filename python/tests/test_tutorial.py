"""The four motions of the quick-start guide in its own style: plain mujoco, ikpy's words, servos in a loop."""

import mujoco
import numpy as np
import pytest

import mjarm
from mjarm.ikpy import Chain

DOWN = np.array([0.0, 0.0, -1.0])


@pytest.fixture(scope="module")
def chain():
    return Chain.from_urdf_file(mjarm.Robot("ur5e").file.with_name("ur5e.urdf"))


class World:
    """model, data and the loop, as the guide has them."""

    def __init__(self):
        self.robot = mjarm.Robot("ur5e")
        self.model = mujoco.MjModel.from_xml_path(str(self.robot.file))
        self.data = mujoco.MjData(self.model)
        mujoco.mj_resetDataKeyframe(self.model, self.data, 0)
        self.data.ctrl[:] = self.data.qpos[:6]

    def go(self, joints, seconds=1.0):
        for _ in range(int(seconds / self.model.opt.timestep)):
            self.data.ctrl[:] = joints
            mujoco.mj_step(self.model, self.data)

    def tool(self):
        return self.robot.fk(self.data.qpos)


def active(chain, answer):
    return answer[[link.joint_type == "revolute" for link in chain.links]]


def start_of(chain, joints):
    start = np.zeros(len(chain))
    start[[link.joint_type == "revolute" for link in chain.links]] = joints
    return start


def follow(world, chain, points, seconds=0.1):
    """Inverse kinematics point by point, each from the one before; the joints all along."""
    joints, way = start_of(chain, world.data.qpos[:6]), []
    for point in points:
        joints = chain.inverse_kinematics(point, DOWN, "Z", initial_position=joints)
        way.append(active(chain, joints))
        world.go(way[-1], seconds)
    return np.array(way)


def at(chain, world):
    """The tool's place in the base link of the URDF."""
    return chain.forward_kinematics(start_of(chain, world.data.qpos[:6]))[:3, 3]


def test_point(chain):
    world = World()
    goal = np.array([0.3, -0.3, 0.4])
    follow(world, chain, [goal], seconds=3)
    assert np.linalg.norm(at(chain, world) - goal) < 0.02  # servos sag


def test_joint_waypoints():
    world = World()
    for waypoint in world.robot.home + np.array([[0.4, 0.2, -0.2, 0, 0, 0], [-0.4, 0, 0, 0.3, 0, 0], [0.0] * 6]):
        for q in np.linspace(world.data.qpos[:6], waypoint, 50):
            world.go(q, 0.02)
        world.go(waypoint, 1)
        assert np.abs(world.data.qpos[:6] - waypoint).max() < 0.05


def test_line(chain):
    world = World()
    points = np.linspace([0.3, -0.3, 0.4], [0.3, 0.3, 0.4], 60)
    way = follow(world, chain, points)
    assert np.abs(np.diff(way, axis=0)).max() < 0.2  # no flip on the way
    assert np.linalg.norm(at(chain, world) - points[-1]) < 0.03


def test_ellipse(chain):
    world = World()
    theta = np.linspace(0, 2 * np.pi, 80)
    points = np.stack([0.4 + 0.1 * np.cos(theta), 0.15 * np.sin(theta), np.full(80, 0.4)], axis=1)
    way = follow(world, chain, points)
    assert np.abs(np.diff(way, axis=0)).max() < 0.3
    assert np.linalg.norm(at(chain, world) - points[-1]) < 0.03


def test_the_guides_own_ellipse_is_refused_where_it_passes_the_base(chain):
    """It is given in the scene's world, against which the URDF's base is turned by pi."""
    theta = np.linspace(0, 2 * np.pi, 200)
    points = np.stack([0.3 * np.cos(theta), -0.2 + 0.15 * np.sin(theta), np.full(200, 0.5)], axis=1)
    frame = mjarm.Pose(euler=[0, 0, np.pi]) @ mjarm.Pose(euler=[3.14, 0, 0])
    refused, joints = [], np.zeros(len(chain))
    for i, point in enumerate(points * [-1, -1, 1]):
        try:
            joints = chain.inverse_kinematics(point, frame.rotation, "all", initial_position=joints)
        except mjarm.Unreachable as failure:
            refused.append(i)
            assert failure.reason is mjarm.IkReason.inner_void
    assert refused == list(range(37, 63))


def test_the_guides_own_ellipse_in_one_call():
    robot = mjarm.Robot("ur5e")
    path = robot.follow(mjarm.Curve.ellipse([0, -0.2, 0.5], 0.3, 0.15, euler=[3.14, 0, 0]).poses(200))
    assert path.reason is mjarm.PathReason.inner_void and path.at in range(30, 45)
    assert path.fixes and path.fixes[0].kind == "shift"
