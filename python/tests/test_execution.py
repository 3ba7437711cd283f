"""Simulation: motions are executed, and what came of them is told, drawn and kept."""

import json
import shutil
import struct

import numpy as np
import pytest

import mjarm


@pytest.fixture(scope="module")
def robot():
    return mjarm.Robot("ur5e")


@pytest.fixture(scope="module")
def line(robot):
    begin = robot.fk(robot.home)
    return robot.time(robot.line(begin, mjarm.Pose(begin.pos + [0.2, 0, -0.1], quat=begin.quat), robot.home))


@pytest.fixture(scope="module")
def run(robot, line):
    return robot.simulate(line)


def size_of(png):
    assert png[:8] == b"\x89PNG\r\n\x1a\n"
    return struct.unpack(">II", png[16:24])


def test_a_line_is_followed(robot, line, run):
    assert run and run.ok and run.reason == "" and run.message == ""
    assert run.report["path_error_max"] < 1e-6 and run.report["coverage"] == 1
    assert run.report["control"] == "computed_torque"
    log = run.log
    n = len(log["time"])
    assert n == run.report["steps"] + 1 and log["contacts"] == [""] * n
    assert log["time"][-1] == pytest.approx(line.duration + 0.5, abs=2 * robot.timestep)
    for name, width in {"q": 6, "q_ref": 6, "v": 6, "ctrl": 6, "torque": 6, "tool_pos": 3, "tool_quat": 4,
                        "tool_ref_pos": 3, "tool_ref_quat": 4}.items():
        assert log[name].shape == (n, width), name
    np.testing.assert_allclose(log["tool_pos"], robot.fk_batch(log["q"])[:, :3, 3], atol=1e-9)
    np.testing.assert_allclose(log["tool_pos"][-1] - log["tool_pos"][0], [0.2, 0, -0.1], atol=1e-6)
    np.testing.assert_allclose(np.linalg.norm(log["tool_quat"], axis=1), 1)


def test_the_servos_alone_sag(robot, line, run):
    sagging = robot.simulate(line, control="servo")
    assert not sagging.ok and sagging.reason == "path_error" and "mm" in sagging.message
    assert sagging.report["path_error_max"] > 100 * run.report["path_error_max"]
    assert robot.simulate(line, control="servo", tolerance=0.5).report["path_error_max"] < 0.5


def test_motions_one_after_another(robot, line):
    back = robot.time([line.at(line.duration)[0], robot.home])
    run = robot.simulate([line, back], rest=0.1)
    assert run.ok
    np.testing.assert_allclose(run.log["q"][-1], robot.home, atol=1e-6)
    assert [move["instruction"] for move in run.report["moves"]] == ["path", "joints"]


def test_a_plan_is_executed_round_the_wall(robot):
    walled = mjarm.Robot(robot.file.with_name("wall.xml"))
    rng = np.random.default_rng(5)
    free = [q for q in rng.uniform(-2.5, 2.5, (20, 6)) if walled.check(q)]
    run = walled.simulate(walled.time(walled.plan(free[0], free[1])))
    assert run.ok and set(run.log["contacts"]) == {""}
    np.testing.assert_allclose(run.log["q"][-1], free[1], atol=1e-6)


def test_what_touches_is_told(robot):
    walled = mjarm.Robot(robot.file.with_name("wall.xml"))
    rng = np.random.default_rng(5)
    free = [q for q in rng.uniform(-2.5, 2.5, (20, 6)) if walled.check(q)]
    pair = next((a, b) for a in free for b in free if not all(walled.check(a + t * (b - a)) for t in np.linspace(0, 1, 50)))
    run = walled.simulate(walled.time(list(pair)))
    assert not run and run.reason == "contact" and run.report["first_contact"]
    assert any(run.log["contacts"])


def test_it_is_drawn(run, tmp_path):
    assert size_of(run.plot())[0] > 500
    assert run._repr_png_() == run.plot()
    run.plot(tmp_path / "plot.svg")
    assert (tmp_path / "plot.svg").read_text(encoding="utf-8").lstrip().startswith("<?xml")
    run.plot(tmp_path / "plot.png")
    assert (tmp_path / "plot.png").read_bytes() == run.plot()
    try:
        picture = run.picture(width=320, height=240)
    except mjarm.NotAvailable:
        pytest.skip("no OpenGL on this machine")
    assert size_of(picture) == (320, 240) and len(picture) > 5000


@pytest.mark.skipif(shutil.which("ffmpeg", path="/usr/bin:/usr/local/bin") is None, reason="no ffmpeg")
def test_it_is_filmed(robot, tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", "/usr/bin:/usr/local/bin")
    run = robot.simulate(robot.time([robot.home, robot.home + 0.1]), rest=0)
    try:
        run.video(tmp_path / "run.mp4", width=160, height=120, fps=10)
    except mjarm.NotAvailable:
        pytest.skip("no OpenGL on this machine")
    assert (tmp_path / "run.mp4").read_bytes()[4:8] == b"ftyp"


def test_it_is_kept_as_the_program_keeps_it(run, tmp_path):
    run.save(tmp_path / "out")
    names = {file.name for file in (tmp_path / "out").iterdir() if not file.name.startswith(".")}
    assert names >= {"report.json", "log.csv", "plot.png", "plot.svg"}
    assert json.loads((tmp_path / "out" / "report.json").read_text(encoding="utf-8")) == run.report
    lines = (tmp_path / "out" / "log.csv").read_text(encoding="utf-8").splitlines()
    assert len(lines) == len(run.log["time"]) + 1
    run.save(tmp_path / "out")  # a second run into the same folder
    (tmp_path / "file").touch()
    with pytest.raises(mjarm.Error):
        run.save(tmp_path / "file")


def test_the_same_again(robot, line, run):
    again = robot.simulate(line)
    assert again.report == run.report
    for name, values in run.log.items():
        np.testing.assert_array_equal(again.log[name], values, err_msg=name)


def test_what_cannot_be_simulated(robot, line, run, tmp_path):
    with pytest.raises(mjarm.BadInput, match="Motion"):
        robot.simulate(robot.home)
    with pytest.raises(mjarm.BadInput, match="one at least"):
        robot.simulate([])
    with pytest.raises(mjarm.BadInput, match="number 1 does not begin"):
        robot.simulate([line, line])
    with pytest.raises(mjarm.BadInput, match="for 6 joints, the robot has 7"):
        mjarm.Robot("panda").simulate(line)
    with pytest.raises(mjarm.Error, match="computed_torque"):
        robot.simulate(line, control="computed_torqe")
    for words in ({"rest": -1}, {"rest": 1e9}, {"tolerance": 0}):
        with pytest.raises(mjarm.BadInput):
            robot.simulate(line, **words)
    with pytest.raises(mjarm.BadInput, match="png"):
        run.plot(tmp_path / "plot.gif")
    with pytest.raises(mjarm.BadInput, match="mp4"):
        run.video(tmp_path / "run.avi")
    with pytest.raises(mjarm.BadInput, match="pixels"):
        run.picture(width=0)
    with pytest.raises(mjarm.Error):
        run.plot(tmp_path / "none" / "plot.png")


def test_robots_plans_and_motions_show_themselves(robot, line, tmp_path):
    assert size_of(line._repr_png_())[0] > 300 and line.plot() == line._repr_png_()
    line.plot(tmp_path / "motion.svg")
    assert b"<svg" in (tmp_path / "motion.svg").read_bytes()
    try:
        picture = robot.picture(robot.home + 0.3, width=320, height=240)
    except mjarm.NotAvailable:
        assert robot._repr_png_() is None
        pytest.skip("no OpenGL on this machine")
    assert size_of(picture) == (320, 240) and picture != robot.picture(width=320, height=240)
    assert size_of(robot._repr_png_()) == (640, 360)
    assert size_of(robot.plan(robot.home, robot.home + 0.5)._repr_png_()) == (640, 360)
    with pytest.raises(mjarm.BadInput, match="png"):
        robot.picture(file=tmp_path / "a.jpg")


def test_progress_is_told(robot, capfd):
    long = robot.time([robot.home + 0.5 * (-1) ** i for i in range(60)], share=0.3)
    lines = []
    mjarm.set_progress(lines.append)
    try:
        robot.simulate(long)
    finally:
        mjarm.set_progress(None)
    assert len(lines) >= 2 and lines[-1] == "" and all("%" in line for line in lines[:-1])
    assert capfd.readouterr().err == ""
    with pytest.raises(mjarm.BadInput, match="show"):
        mjarm.set_progress(3)
