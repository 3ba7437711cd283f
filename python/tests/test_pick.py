"""Objects are picked up and put down: planned from how things stand, executed in MuJoCo, held by friction."""

import numpy as np
import pytest

import mjarm


@pytest.fixture(scope="module")
def robot():
    return mjarm.Robot(mjarm.Robot("ur5e").file.with_name("pick.xml"))


def test_a_can_goes_where_it_is_told(robot):
    place = mjarm.Pose([0.56, -0.33, 0.256])
    plan = robot.pick("can", place, any_turn=True)
    assert len(plan) == len(plan.motions) > 4 and 0.01 < plan.width < 0.2
    np.testing.assert_allclose(plan.place.pos, place.pos, atol=1e-9)
    run = robot.simulate(plan.motions)
    assert run.ok, run.message
    (can,) = [thing for thing in run.report["objects"] if thing["name"] == "can"]
    assert can["carried"] and can["moved"] > 0.3
    assert [motion.closes for motion in plan.motions if motion.closes is not None] == [True, False]
    # Then another one, from how things stand now; both in one simulation.
    then = robot.pick("box", mjarm.Pose([0.44, -0.33, 0.236]), any_turn=True, qpos=run.qpos)
    both = robot.simulate(plan.motions + then.motions)
    assert both.ok, both.message
    np.testing.assert_allclose(both.report["duration"], run.report["duration"] + then.duration, atol=0.01)


def test_it_is_only_lifted(robot):
    plan = robot.pick("box")
    assert plan.place is None
    end = robot.fk(plan.motions[-1].at(plan.motions[-1].duration)[0])
    held = end @ plan.grasp.inverse()
    assert held.pos[2] - robot.frame("box").pos[2] == pytest.approx(0.1, abs=0.02)


def test_why_not(robot):
    with pytest.raises(mjarm.NoPick) as failure:
        robot.pick("cann")
    assert failure.value.reason == "no_object" and "can" in str(failure.value)
    with pytest.raises(mjarm.NoPick) as failure:
        robot.pick("can", mjarm.Pose([3, 0, 0.3]))
    assert failure.value.reason == "place_out_of_reach" and failure.value.dropped
    with pytest.raises(mjarm.NoPick, match="no body"):
        mjarm.Robot("ur5e").pick("can")
    with pytest.raises(mjarm.BadInput, match="qpos"):
        robot.pick("can", qpos=[1, 2])
