"""Scripts in ikpy's words."""

import numpy as np
import pytest

import mjarm
from mjarm.ikpy import Chain


@pytest.fixture(scope="module")
def urdf():
    return mjarm.Robot("ur5e").file.with_name("ur5e.urdf")


@pytest.fixture(scope="module")
def chain(urdf):
    return Chain.from_urdf_file(urdf, active_links_mask=None)


def moving(chain, rng):
    """One number a link, drawn within the bounds."""
    return np.array([0 if link.joint_type == "fixed" else rng.uniform(max(link.bounds[0], -3), min(link.bounds[1], 3))
                     for link in chain.links])


def test_has_ikpys_shapes(chain):
    assert len(chain) == len(chain.links) == len(chain.active_links_mask) > 6
    assert chain.links[0].name == "Base link"
    assert sum(link.joint_type == "revolute" for link in chain.links) == 6
    frame = chain.forward_kinematics([0] * len(chain))
    assert frame.shape == (4, 4)
    answer = chain.inverse_kinematics(frame[:3, 3] * 0.8)
    assert answer.shape == (len(chain),) and answer[0] == 0


def test_comes_to_places_axes_and_frames(chain):
    rng = np.random.default_rng(1)
    for _ in range(20):
        joints = moving(chain, rng)
        target = chain.forward_kinematics(joints)
        place = chain.inverse_kinematics(target[:3, 3], initial_position=joints)
        np.testing.assert_allclose(chain.forward_kinematics(place)[:3, 3], target[:3, 3], atol=1e-6)
        for column, axis in enumerate("XYZ"):
            answer = chain.inverse_kinematics(target[:3, 3], 2 * target[:3, column], axis, initial_position=joints)
            reached = chain.forward_kinematics(answer)
            np.testing.assert_allclose(reached[:3, 3], target[:3, 3], atol=1e-6)
            np.testing.assert_allclose(reached[:3, column], target[:3, column], atol=1e-6)
        answer = chain.inverse_kinematics(target[:3, 3], target[:3, :3], "all", initial_position=joints)
        np.testing.assert_allclose(answer, joints, atol=1e-5)
        np.testing.assert_allclose(chain.inverse_kinematics_frame(target, joints, orientation_mode="all"), joints, atol=1e-5)


def test_a_tip_and_another_base(urdf, chain):
    longer = Chain.from_urdf_file(urdf, last_link_vector=[0, 0, 0.1])
    assert len(longer) == len(chain) + 1
    np.testing.assert_allclose(longer.forward_kinematics([0] * len(longer)),
                               chain.forward_kinematics([0] * len(chain)) @ mjarm.Pose([0, 0, 0.1]).matrix, atol=1e-12)
    named = Chain.from_urdf_file(urdf, base_elements=["base_link"])
    np.testing.assert_array_equal(named.forward_kinematics([0.1] * len(named)), chain.forward_kinematics([0.1] * len(chain)))


def test_raises_where_ikpy_would_not(urdf, chain):
    with pytest.raises(mjarm.Unreachable, match="stretch") as told:
        chain.inverse_kinematics([2, 0, 0])
    assert 0.9 < told.value.amount < 1
    for words in ({"target_position": None}, {"target_position": [0, 0, 0.5], "orientation_mode": "W"},
                  {"target_position": [0, 0, 0.5], "target_orientation": [0, 0, 0], "orientation_mode": "Z"},
                  {"target_position": [0.3, 0, 0.5], "initial_position": [0, 0]}):
        with pytest.raises(mjarm.BadInput):
            chain.inverse_kinematics(**words)
    with pytest.raises(mjarm.BadInput, match="one number a link"):
        chain.forward_kinematics([0, 0])
    with pytest.raises(mjarm.BadInput, match="no link"):
        Chain.from_urdf_file(urdf, base_elements=["nothing"])
    with pytest.raises(mjarm.BadInput, match="left out"):
        Chain.from_urdf_file(urdf, active_links_mask=[False] * len(chain))
    with pytest.raises(mjarm.BadInput):
        Chain.from_urdf_file("no/such.urdf")
