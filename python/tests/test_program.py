"""Motion programs: read, checked, run; the same as the program `mjarm` does."""

import subprocess
import sys

import numpy as np
import pytest

import mjarm

GOOD = """robot: ur5e
program:
  - movej: {pos: [0.1, -0.45, 0.4], euler: [180deg, 0, 0]}
  - movel: {pos: [-0.1, -0.45, 0.4], euler: [180deg, 0, 0], speed: 0.2}
  - wait: 100ms
"""
BAD = """robot: ur5e
program:
  - movej: {pos: [0.1, -1.45, 0.4], euler: [180deg, 0, 0]}
  - movel: {pos: [0.1, -0.45, 0.4], euler: [180deg, 0, 0]}
  - movej: {joints: [0, 0, 9, 0, 0, 0]}
"""


def test_a_text_is_planned_and_run():
    program = mjarm.Program.parse(GOOD)
    assert len(program) == 3 and program.robot.dof == 6
    plan = program.check()
    assert plan and plan.ok and plan.faults == [] and len(plan) == 3
    assert [motion.word for motion in plan.motions] == ["movej", "movel", "wait"]
    assert [motion.line for motion in plan.motions] == [3, 4, 5]
    assert plan.duration == pytest.approx(sum(motion.duration for motion in plan.motions))
    run = plan.run()
    assert run.ok and run.report["path_error_max"] < 1e-6
    np.testing.assert_allclose(run.log["tool_pos"][-1], [-0.1, -0.45, 0.4], atol=1e-6)
    # Motions of a program are motions.
    assert program.robot.simulate(plan.motions).log["q"][-1] == pytest.approx(run.log["q"][-1], abs=1e-9)


def test_all_faults_are_listed():
    plan = mjarm.Program.parse(BAD).check()
    assert not plan
    assert [(fault.line, fault.word) for fault in plan.faults] == [(3, "movej"), (5, "movej")]
    assert plan.faults[0].reason == "out_of_reach" and "m" in plan.faults[0].message
    assert "movej" in str(plan.faults[0])
    with pytest.raises(mjarm.Impossible, match="3:5.*1 more"):
        plan.run()
    with pytest.raises(mjarm.Impossible, match="3:5"):
        plan.urscript()


def test_what_is_wrong_with_a_text():
    with pytest.raises(mjarm.BadInput, match="program:3:5.*movej"):
        mjarm.Program.parse("robot: ur5e\nprogram:\n  - movji: {joints: home}\n")
    with pytest.raises(mjarm.BadInput, match="ur5e"):
        mjarm.Program.parse("robot: ur5\nprogram:\n  - movej: {joints: home}\n")
    with pytest.raises(mjarm.BadInput, match="no_such"):
        mjarm.Program.load("no_such")
    with pytest.raises(mjarm.BadInput, match="max_duration"):
        mjarm.Program.parse("robot: ur5e\nprogram:\n  - wait: 80000\n").run()
    with pytest.raises(mjarm.Error, match="servo"):
        mjarm.Program.parse(GOOD).run(control="srvo")


def test_the_same_bytes_as_the_program(tmp_path):
    file = tmp_path / "cell.yaml"
    file.write_text(GOOD)
    done = subprocess.run([sys.executable, "-m", "mjarm", "run", str(file), "--headless", "--no-timing", "--out",
                           str(tmp_path / "theirs")], capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    mjarm.Program.load(file).run().save(tmp_path / "ours")
    for name in ("report.json", "log.csv", "plot.svg"):
        assert (tmp_path / "ours" / name).read_bytes() == (tmp_path / "theirs" / name).read_bytes(), name
    script = subprocess.run([sys.executable, "-m", "mjarm", "export", str(file), "--to", "urscript"], capture_output=True,
                            text=True, timeout=300)
    assert mjarm.Program.load(file).urscript() == script.stdout


def test_a_program_that_looks(tmp_path):
    """See it, grasp it, place it."""
    try:
        run = mjarm.Program.load("pick_place").run()
    except mjarm.NotAvailable:
        pytest.skip("no OpenGL on this machine")
    assert run.ok, run.message
    moved = {thing["name"]: thing for thing in run.report["objects"]}
    assert any(thing["carried"] for thing in moved.values())


def test_motions_of_another_tool_belong_to_their_program():
    text = "robot: panda\nprogram:\n  - set: {tool: hand}\n  - movej: {joints: [0.1, -0.3, 0, -2, 0, 1.8, 0.7]}\n"
    program = mjarm.Program.parse(text)
    assert program.run().ok
    with pytest.raises(mjarm.BadInput, match="another tool"):
        program.robot.simulate(program.check().motions)
