"""The package as it is installed: one MuJoCo, quick to import, a program, and no way to crash it."""

import importlib.metadata
import json
import os
import pathlib
import random
import re
import subprocess
import sys
import threading

import numpy as np
import pytest

import mjarm
from mjarm._core import ReachBatch
from mjarm.ikpy import Chain


def python(code, **environment):
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120,
                          env={**os.environ, **environment})


def program(*words):
    return subprocess.run([sys.executable, "-m", "mjarm", *words], capture_output=True, text=True, timeout=300)


def test_shares_the_library_of_mujoco():
    done = python("import mjarm, mujoco; print(mjarm.mujoco_version() == mujoco.__version__); "
                  "print(len({l.split()[-1] for l in open('/proc/self/maps') if 'libmujoco.so' in l}))")
    assert done.stdout.split() == ["True", "1"], done.stderr
    done = python("import mujoco, mjarm; mjarm.Robot('ur5e'); mujoco.MjModel.from_xml_string('<mujoco/>'); print(1)")
    assert done.stdout.split() == ["1"], done.stderr


def test_another_mujoco_is_told(tmp_path):
    (tmp_path / "mujoco").mkdir()
    (tmp_path / "mujoco" / "__init__.py").touch()
    done = python("import mjarm", PYTHONPATH=str(tmp_path))
    assert "ImportError: mjarm needs the library of MuJoCo 4.0" in done.stderr
    (tmp_path / "mujoco" / "libmujoco.so.3.3.7").touch()
    done = python("import mjarm", PYTHONPATH=str(tmp_path))
    assert "libmujoco.so.3.3.7 is installed" in done.stderr


def test_imports_nothing_that_is_not_needed():
    done = python("import sys, mjarm; print(*sorted(sys.modules))")
    loaded = set(done.stdout.split())
    assert "mjarm._core" in loaded
    assert not loaded & {"scipy", "matplotlib", "torch", "gymnasium", "mujoco", "pandas"}


def test_a_run_as_a_page(tmp_path):
    page = pathlib.Path(mjarm.__file__).parent / "share" / "mjarm" / "page" / "index.html"
    if not page.exists():
        pytest.skip("the wheel was built without the page: it takes Node")
    done = program("run", "movel", "--headless", "--out", str(tmp_path / "out"), "--html", str(tmp_path / "run.html"))
    assert done.returncode == 0, done.stderr
    text = (tmp_path / "run.html").read_text(encoding="utf-8")
    assert "Content-Security-Policy" in text and 100_000 < len(text) < 4_000_000


def test_a_notebook_shows_progress():
    code = "import sys, types; sys.modules['ipykernel'] = types.ModuleType('ipykernel'); import mjarm; r = mjarm.Robot('ur5e'); " \
           "r.simulate(r.time([r.home + 0.5 * (-1) ** i for i in range(60)], share=0.3))"
    done = python(code)
    assert done.returncode == 0 and "%" in done.stderr, done.stderr
    assert not done.stderr.splitlines()[-1].strip()  # it is taken away in the end


def test_types_are_told():
    stub = pathlib.Path(mjarm.__file__).with_name("_core.pyi")
    assert "def ik(self, pose: PoseLike" in stub.read_text()
    assert stub.with_name("py.typed").exists()


def test_tells_its_version():
    assert mjarm.__version__ == importlib.metadata.version("mjarm")


def test_the_program_is_the_same(tmp_path):
    done = program("ik", "--robot", "ur5e", "--pos", "-0.13,0.6,0.1", "--euler", "3.14,0,1.57", "--no-timing")
    assert done.returncode == 0, done.stderr
    q = mjarm.Robot("ur5e").ik(mjarm.Pose([-0.13, 0.6, 0.1], euler=[3.14, 0, 1.57])).q
    assert json.loads(done.stdout)["q"] == q.tolist()  # to the last bit
    assert program("no_such_command").returncode == 2
    done = program("doctor")  # which MuJoCo is there (4.0.0 with the package mujoco) is no fault
    assert done.returncode == 0, done.stdout + done.stderr
    done = program("demo", "ellipse", "--headless", "--out", str(tmp_path / "out"))
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "out" / "report.json").stat().st_size > 100


def test_has_the_pages_to_learn_from():
    done = program("learn", "--json")
    pages = [pathlib.Path(page["file"]) for page in json.loads(done.stdout)["pages"]]
    assert len(pages) == 9
    for page in pages:
        links = re.findall(r"\]\((\.\./[^)#]+)", page.read_text())
        assert [link for link in links if not (page.parent / link).exists()] == []


def test_speaks_chinese():
    code = "import mjarm; mjarm.set_language('zh')\ntry: mjarm.Robot('ur5e').ik(mjarm.Pose([2, 0, 0]))\n" \
           "except mjarm.Unreachable as e: print(e)"
    assert "超出可达范围" in python(code, PYTHONIOENCODING="utf-8").stdout
    with pytest.raises(mjarm.BadInput):
        mjarm.set_language("xx")
    before = mjarm.language()
    try:
        mjarm.set_language("zh-CN")
        assert mjarm.language() == "zh"
        with pytest.raises(mjarm.BadInput, match="应为数字，而不是 str"):
            mjarm.Pose("here")
        with pytest.raises(mjarm.BadInput, match="没有连杆"):
            Chain.from_urdf_file(mjarm.Robot("ur5e").file.with_name("ur5e.urdf"), base_elements=["x"])
    finally:
        mjarm.set_language(before)


def test_both_languages_leave_the_same_places_open():
    catalogue = pathlib.Path(__file__).parents[1] / "messages" / "python.inc"
    texts = re.findall(r'MJARM_MSG\(\w+,\s*"(.*?)",\s*"(.*?)"\)', catalogue.read_text(encoding="utf-8"), re.DOTALL)
    assert len(texts) > 20
    for english, chinese in texts:
        assert english.count("{}") == chinese.count("{}"), english


@pytest.mark.filterwarnings("ignore:nanobind")  # an object that is made a second time
def test_nothing_a_caller_gives_crashes_it(tmp_path, monkeypatch):
    """A thousand wrong calls over the whole surface, from two threads, each end in an exception, or in an answer."""
    monkeypatch.chdir(tmp_path)
    robot = mjarm.Robot("ur5e")
    motion = robot.time([robot.home, robot.home + 0.05])
    frame = mjarm.Frame(np.zeros((4, 4, 3), np.uint8), np.zeros((4, 4)), fx=1, fy=1, cx=1, cy=1)
    things = [robot, motion, frame, mjarm.Pose(), robot.limits, robot.controller(), robot.tracker(), robot.simulate(motion, rest=0),
              robot.line(robot.fk(robot.home), mjarm.Pose([9, 9, 9])), mjarm.Region(mjarm.Pose()), mjarm.Policy.load("reach"),
              mjarm.Program.parse("robot: ur5e\nprogram:\n  - wait: 1ms\n"), mjarm.Curve.line(mjarm.Pose(), mjarm.Pose([1, 0, 0])),
              robot.plan(robot.home, robot.home + 0.05), ReachBatch(), mjarm.Payload(1.0),
              mjarm.JointLog(0.002, np.zeros((2000, 6)), np.zeros((2000, 6)))]
    odd = [None, 0, -1, 1e308, float("nan"), "", "x" * 1000, b"\0", [], [[]], [1, [2]], {}, (), object(), *things, mjarm.Pose,
           lambda *a: 1, np.zeros((0, 6)), np.zeros((3, 6)), np.zeros((2, 4, 4)), np.eye(4), np.eye(4, dtype=np.float32),
           np.full(6, 1e300), np.array(["a"] * 6), np.zeros(6)[::-1], np.zeros((6, 12))[:, ::2], np.zeros(7), range(6),
           memoryview(b"123456"), True, 10**40, [None] * 6, np.zeros(6, dtype=complex), np.zeros((4, 4, 3), np.uint8)]
    calls = [getattr(thing, name) for thing in things for name in dir(thing)
             if not name.startswith("_") and name not in ("video", "mujoco_version") and callable(getattr(thing, name))]
    calls += [getattr(mjarm.Pose(), name) for name in ("__matmul__", "__setstate__")]
    calls += [getattr(mjarm, name) for name in mjarm.__all__ if name not in ("view", "language", "set_language", "set_progress")]
    calls += [mjarm.Curve.ellipse, mjarm.Curve.polyline, mjarm.Curve.spline, mjarm.Pose.from_matrix, mjarm.Program.load,
              mjarm.Program.parse, mjarm.Policy.load, mjarm.Region.bounds]
    names = ["seed", "task", "pos_tol", "max_step", "valid", "threads", "euler", "quat", "tip", "windings", "max", "control", "rest",
             "q", "qpos", "file", "width", "place", "held", "share", "tool_speed", "start"]
    refused = []

    def call_wrongly(seed):
        chance = random.Random(seed)
        for _ in range(500):
            words = {name: chance.choice(odd) for name in chance.sample(names, chance.choice([0, 0, 1, 2]))}
            try:
                chance.choice(calls)(*chance.choices(odd, k=chance.randrange(4)), **words)
            except (mjarm.Error, TypeError, OverflowError, ValueError, KeyError, AttributeError):
                refused.append(1)

    threads = [threading.Thread(target=call_wrongly, args=(seed,)) for seed in (1, 2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(refused) > 700
    assert robot.ik(robot.fk(robot.home)).pos_err < 1e-7


def test_beside_the_renderer_of_mujoco():
    """Both draw in one process, in turn."""
    code = """
import mujoco, mjarm
robot = mjarm.Robot("ur5e")
model = mujoco.MjModel.from_xml_path(str(robot.file)); data = mujoco.MjData(model); mujoco.mj_forward(model, data)
try: renderer = mujoco.Renderer(model, 60, 80)
except Exception: print("none"); raise SystemExit
def draw(): renderer.update_scene(data); return renderer.render().tobytes()
theirs, ours = draw(), robot.picture(width=80, height=60)
print(draw() == theirs, robot.picture(width=80, height=60) == ours, len(set(theirs)) > 50)
"""
    done = python(code, MUJOCO_GL="egl", PYOPENGL_PLATFORM="egl")
    if done.stdout.split() == ["none"]:
        pytest.skip("MuJoCo's own renderer does not work on this machine")
    assert done.stdout.split() == ["True"] * 3, done.stderr
