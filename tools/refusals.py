"""Asks mjarm for what it once refused wrongly or answered slowly, by its command line alone, and prints what it says now beside what it said then.

Usage: refusals.py --program MJARM [--peers VENV]. VENV is a Python environment with sscbirrt (./dev peers near). Nothing that is kept from run to run
is used. The last line printed is "PASSED FAILED SKIPPED", three numbers; one of each is a row of the table.
"""

import argparse
import json
import os
import pathlib
import re
import resource
import signal
import subprocess
import tempfile
import time
from typing import Callable, NamedTuple

TIMEOUT = 400  # [s] for one command
CPU = 10       # [s] of all processors for one answer, or one reason
STOP = 1       # [s] from a signal to the end

WALL = "universal_robots_ur5e/wall.xml"
PICK = {"UR5e": "universal_robots_ur5e/pick.xml", "Panda": "franka_emika_panda/pick.xml"}
SHIPPED = ["ur5e", "panda", *PICK.values()]
CAN = "0.52,0.2,0.25"  # where it stands in these scenes
SIDES = "frame=can tool-euler=0,90deg,0 yaw=free z=2cm"  # any side of it
BEFORE_DOOR = "-68.5deg,-124.2deg,-72.8deg,-163deg,-68.5deg,0"
DOOR = "pos=10cm,-72cm,30cm tool-euler=90deg,0,0 hinge-pos=40cm,-95cm,0 hinge={}deg..{}deg "
HANDLE = "x=1cm y=1cm z=1cm roll=3deg pitch=3deg "


class Wrong(Exception):
    """A row is not as it should be."""


class Absent(Exception):
    """A row cannot be measured here."""


def expect(holds, otherwise):
    if not holds:
        raise Wrong(otherwise)


def processors():
    """What all programs that ended took of them [s]."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


class Ran(NamedTuple):
    code: int
    out: str
    err: str
    wall: float  # [s]
    cpu: float   # [s] of all processors

    @property
    def said(self):
        return self.err.strip().splitlines()[-1] if self.err.strip() else f"exit code {self.code}"

    def __str__(self):
        return f"{self.wall:.2f} s, processors {self.cpu:.2f} s"


class Mjarm:
    """The program, as a user of a terminal has it, in a folder of its own."""

    def __init__(self, program, folder, peers=None):
        self.command, self.folder, self.peers = [str(program), "--lang", "en"], pathlib.Path(folder), peers
        self.environment = {**os.environ, "MJARM_CACHE": "off"}

    def write(self, name, text):
        self.folder.joinpath(name).write_text(text, encoding="utf-8")
        return name

    def run(self, *words):
        before, begin = processors(), time.monotonic()
        done = subprocess.run([*self.command, *words], cwd=self.folder, env=self.environment, stdin=subprocess.DEVNULL, capture_output=True,
                              text=True, timeout=TIMEOUT, check=False)
        return Ran(done.returncode, done.stdout, done.stderr, time.monotonic() - begin, processors() - before)

    def done(self, *words):
        """Runs what has to succeed."""
        ran = self.run(*words)
        expect(ran.code == 0, f"{words[0]}: {ran.said}")
        return ran

    def refused(self, reason, *words):
        """Runs what has to be refused, in words that `reason`, a regular expression, finds, and soon."""
        ran = self.run(*words)
        expect(ran.code == 1, f"{words[0]}: exit code {ran.code}, expected 1: {ran.said}")
        expect(re.search(reason, ran.err), f'{words[0]}: "{reason}" is not said: {ran.said}')
        expect(ran.cpu < CPU, f"{words[0]}: the reason took {ran}")
        return ran

    def planned(self, robot, *words):
        """Plans what has a path, soon, and has it verified."""
        ran = self.done("plan", "--robot", robot, *words, "--out", "path.json")
        expect(ran.cpu < CPU, f"plan: it took {ran}")
        expect(json.loads(self.done("verify", "path.json", "--robot", robot, "--json").out)["valid"] == 1, "verify: the path is not valid")
        return ran

    def findings(self, file, code):
        """What `model check` finds of one kind."""
        return [one for one in json.loads(self.run("model", "check", file, "--json").out)["findings"] if one["code"] == code]


# Arms that the rows are asked of: hinges as (place, axis, range) from base to tip; `off` is how far they are from a closed form.
WRIST = [("0 0 0.3", "0 0 1", 3), ("0.05 0 0", "0 1 0", 2), ("0 0 0.4", "0 1 0", 2.5), ("0.03 0 0.35", "0 0 1", 3),
         ("{off} {off} 0", "0 1 0", 2), ("0 {off} 0", "0 0 1", 3)]
PARALLEL = [("0 0 0.15", "0 0 1", 3.1), ("0 0.12 0", "0 1 0", 3.1), ("0 -0.1 0.4", "{off} 1 0", 2.8), ("0 0 0.4", "0 1 {off}", 3.1),
            ("0 0.1 0", "0 0 1", 3.1), ("0 0 0.1", "0 1 0", 3.1)]
STRAIGHT = [("0 0 0.3", "0 0 1", 2.9), ("0 0 0", "0 1 0", 2), ("0 0 0.2", "0 0 1", 2.9), ("0 0 0.2", "0 -1 0", 2),
            ("0 0 0.2", "0 0 1", 2.9), ("0 0 0.2", "0 1 0", 2), ("0 0 0.08", "0 0 1", 2.9)]
LEVEL = [("0 0 0.3", "0 0 1", 1), ("0.3 0 0", "0 0 1", 1), ("0.3 0 0", "0 0 1", 1)]
SMALL = [("0 0 0.05", "0 0 1", 3), ("0 0 0.05", "0 1 0", 2), ("0 0 0.1", "0 1 0", 2)]
BALL = '<geom size="0.02" mass="1"/>'
FINGER = ('<body name="{0}_finger" pos="0 {1} 0.06"><joint name="{0}_finger" type="slide" axis="0 {2} 0" range="0 0.04"/>'
          '<geom type="box" size="0.01 0.005 0.03" mass="0.05"/></body>')
HAND = FINGER.format("left", 0.01, 1) + FINGER.format("right", -0.01, -1)


def mjcf(rows, off=0.0, base="", hand='<site name="tool" pos="0.02 0 0.1"/>', scene="", forearm=BALL, ranges=(), home=""):
    """An arm of `rows` as MJCF. base, hand and scene are put there; forearm: the shape of its third link; ranges: of the commands of its servos."""
    text = f'<mujoco model="own"><compiler angle="radian"/><worldbody>{scene}<body name="base">{base}<geom size="0.02" mass="9" contype="0"/>'
    for n, (place, axis, most) in enumerate(rows, 1):
        text += (f'<body name="link{n}" pos="{place.format(off=off)}"><joint name="joint{n}" axis="{axis.format(off=off)}" range="-{most} {most}"/>'
                 f"{forearm if n == 3 else BALL}")
    text += hand + "</body>" * (len(rows) + 1) + "</worldbody><actuator>"
    for n, limits in enumerate(ranges, 1):
        text += f'<position name="servo{n}" joint="joint{n}" kp="500" kv="50" forcerange="-90 90" ctrlrange="{limits}"/>'
    for joint in re.findall('joint name="([a-z]*_finger)"', hand):
        text += f'<position name="{joint}" joint="{joint}" kp="50" ctrlrange="0 0.04"/>'
    return text + "</actuator>" + (f'<keyframe><key name="home" qpos="{home}"/></keyframe>' if home else "") + "</mujoco>"


# One function for a row, or a part of it: what is measured now, else Wrong or Absent.

def hard_poses(mjarm, robots, sets=None):
    right, cases, missed = 0, 0, []
    for robot in robots:
        ran = mjarm.run("bench", "ik", "--hard", "--rounds", "1", "--no-timing", "--json", "--robot", robot)
        expect(ran.out, f"bench ik: {ran.said}")
        for run in (run for run in json.loads(ran.out)["robots"][0]["runs"] if run["set"] in (sets or (run["set"],))):
            right, cases = right + run["right"], cases + run["cases"]
            missed += [f"{robot} {run['set']}"] * (run["cases"] - run["right"])
    expect(not missed and cases, f"{right} of {cases} right, not: {', '.join(missed)}")
    return f"{right} of {cases} right"


def near_forms(mjarm):
    return hard_poses(mjarm, [mjarm.write(f"{name}_{off}.xml", mjcf(rows, off)) for off in (1e-5, 1e-6)
                              for name, rows in (("wrist", WRIST), ("parallel", PARALLEL))])


def all_branches(mjarm, off):
    ran = mjarm.done("bench", "ik", "--all", "--rounds", "1", "--no-timing", "--json", "--robot", mjarm.write("all.xml", mjcf(PARALLEL, off)))
    missed, known = next((run["missed"], run["known"]) for run in json.loads(ran.out)["robots"][0]["runs"] if run["who"] == "mjarm")
    expect(missed == 0 and known > 1000, f"{missed} of {known} branches lost")
    return f"{missed} of {known} branches lost"


def two_actuators(mjarm):
    palm = f'<body name="palm" pos="0 0 0.1"><joint name="joint_gripper" axis="0 0 1" range="-3 3"/>{BALL}<site name="grip" pos="0 0 0.1"/>{HAND}</body>'
    arm = json.loads(mjarm.done("model", "info", mjarm.write("hand.xml", mjcf(STRAIGHT[:6], hand=palm)), "--json").out)["arm"]
    others = (arm["gripper"] or {}).get("others", [])
    expect(len(arm["joints"]) == 7 and [one["actuator"] for one in others] == ["right_finger"], f"{len(arm['joints'])} joints, gripper: {arm['gripper']}")
    return "7 joints, gripper of 2 actuators"


def model_faults(mjarm):
    wrong = mjarm.write("wrong.xml", mjcf(WRIST, base="<freejoint/>", ranges=["-0.9 0.9", "1 5", "-60 60", "-9 9", "1 3", "0 1"]))
    ranges, floats = len(mjarm.findings(wrong, "ctrl_range_differs")), len(mjarm.findings(wrong, "base_floats"))
    expect(ranges == 6 and floats == 1, f"{ranges} of 6 faults of ctrlrange, {floats} of 1 floating base")
    expect(mjarm.findings(mjarm.write("sound.xml", mjcf(WRIST, ranges=["-2 2"] * 6)), "servo_sag"), "a tool that hangs is not told")
    expect(not mjarm.findings(mjarm.write("level.xml", mjcf(LEVEL, ranges=["-1 1"] * 3)), "servo_sag"), "a level arm is said to hang")
    return "6 of 6 ctrlrange, base found, 0 nothings"


def near_home(mjarm, gap):
    """A forearm, a box, that stands so far from a wall [m] at home."""
    forearm = '<geom type="box" size="0.03 0.03 0.1" pos="0 0 0.2" mass="1"/>'
    wall = f'<geom name="wall" type="box" size="0.02 0.5 0.08" pos="{0.05 + 0.03 + 0.02 + gap} 0 0.9"/>'
    file = mjarm.write("near.xml", mjcf(WRIST, forearm=forearm, scene=wall, home="0 0 0 0 0 0"))
    return f'planned: {mjarm.planned(file, "--goal=0.5,-0.6,0.5,0,0,0")}'


def grasp(mjarm):
    return f'{mjarm.planned(PICK["UR5e"], "--pos", CAN, "--euler", "180deg,0,0")}; {mjarm.planned(PICK["Panda"], "--goal-region", SIDES)}'


def touching(mjarm):
    seconds = []
    for robot, where, pair in ((PICK["UR5e"], "180deg,-20deg,60deg,-90deg,-90deg,0", '"left_finger" overlaps obstacle "floor"'),
                               (PICK["Panda"], "0,1.2,0,-1,0,2.4,0", '"link5" overlaps obstacle "table_top"')):
        seconds.append(mjarm.refused(f"goal.*{pair}", "plan", "--robot", robot, f"--goal={where}").cpu)
        seconds.append(mjarm.refused(f"start.*{pair}", "plan", "--robot", robot, f"--start={where}", "--pos", CAN, "--euler", "180deg,0,0").cpu)
    return "goal {:.2f} s, start {:.2f} s; goal {:.2f} s, start {:.2f} s".format(*seconds)


def stopped(mjarm, by):
    """A signal in a search that would go on for minutes: one that goes on to look for a shorter path."""
    words = ["plan", "--robot", WALL, "--time-budget", "200s", f"--start={BEFORE_DOOR}", "--goal-region",
             DOOR.format(-68, -67) + "yaw=3deg", "--out", "stopped.json"]
    with subprocess.Popen([*mjarm.command, *words], cwd=mjarm.folder, env=mjarm.environment, stderr=subprocess.PIPE, text=True) as search:
        time.sleep(1.5)
        expect(search.poll() is None, "the search had ended before it was to be stopped")
        begin = time.monotonic()
        search.send_signal(by)
        try:
            err = search.communicate(timeout=60)[1]
        finally:
            search.kill()  # where it is still there
        took = time.monotonic() - begin
    expect(took < STOP and "stopped" in err, f"{took:.2f} s to the end, exit code {search.returncode}: {err.strip()}")
    return f"ended after {took:.2f} s"


def regions(mjarm):
    mjarm.planned(PICK["UR5e"], "--goal-region", "pos=0,0,3", "--goal-region", SIDES)
    path = json.loads((mjarm.folder / "path.json").read_text(encoding="utf-8"))
    expect(next(iter(path.values()))["goal_region"] == 1, "the region that cannot be reached was taken")
    # Of this one, in a wall, but the top is free: the first draws are not.
    mjarm.planned(WALL, "--start=-4.375,-1.2456,1.9905,-2.3157,-1.5708,0", "--goal-region",
                  "pos=0,-0.5,0.2 euler=180deg,0,0 x=2cm y=10cm z=21.5cm lean=0.1 yaw=1")
    return "side grasp, one of two, one with a free corner: planned"


def door(mjarm):
    ran = mjarm.planned(WALL, f"--start={BEFORE_DOOR}", "--goal-region", DOOR.format(-77, -75) + "yaw=50deg",
                        "--keep-within", DOOR.format(-80, 2) + HANDLE + "yaw=50deg")
    return f"door opened by 76 deg: {ran}"


def durations(mjarm):
    if not mjarm.peers:
        raise Absent("no environment with sscbirrt: ./dev peers near")
    said = json.loads(mjarm.done("bench", "plan", "--set", "near", "--goals", "40", "--peers", str(mjarm.peers), "--json", "--out", "near").out)
    means = [(run["motion_ratio"]["mean"], run["jerk_limited_motion_ratio"]["mean"]) for robot in said["robots"] for run in robot["runs"]
             if run["who"].startswith("sscbirrt") and run["set"] == "all"]
    now = "; ".join(f"{plain:.3f} / {smooth:.3f}" for plain, smooth in means)
    expect(means and all(plain <= 1 and smooth <= 1.05 for plain, smooth in means), now)
    return now


def winding(mjarm):
    ran = mjarm.refused(r"same posture with these joint values: -1\.5708,-1\.19", "plan", "--robot", "ur5e",
                        "--start=-1.5708,-1.5708,1.5708,-1.5708,-1.5708,0", "--goal=-1.5708,5.0832,1.5708,-1.5708,-1.5708,0", "--out", "path.json")
    return f"told with -2 pi: {ran}"


def square(mjarm):
    """A ball of its own is round the shoulder wherever the arm stands."""
    ball = '<body name="ball" pos="0 0 0.3"><freejoint/><geom size="0.06" mass="0.01"/></body>'
    file = mjarm.write("ball.xml", mjcf(WRIST, scene=ball, ranges=["-2 2"] * 6))
    draw = ("demo", "square", "--robot", file, "--headless", "--no-timing", "--overwrite", "--out", "square")
    mjarm.refused('"ball" and "link1" overlap', *draw)
    mjarm.done(*draw, "--allow", "link1,ball", "--allow", "link2,ball")
    return "pair named; drawn with --allow"


def told(mjarm):
    start = mjarm.write("start.xml", mjcf(LEVEL, ranges=["-1 1", "-1 1", "0.2 0.8"], home="0 0.3 -0.4"))
    program = mjarm.write("start.yaml", f"robot: {start}\nprogram:\n  - movej: {{joints: [0.1, 0.3, -0.4]}}\n")
    mjarm.refused(r"can be told 0\.2 to 0\.8 only \(ctrlrange\)", "run", program, "--headless", "--out", "start")
    floats = mjarm.done("sim", mjarm.write("floats.xml", mjcf(LEVEL, base="<freejoint/>", ranges=["-1 1"] * 3)), "--seconds", "0.1", "--out", "sim")
    expect('base "base" floats' in floats.err, "sim: a floating base is not told")
    height = json.loads(mjarm.done("workspace", "--robot", mjarm.write("small.xml", mjcf(SMALL)), "--json").out)["slice"]["at"]
    return f"ctrlrange, floating base told; workspace met at z = {height:g} m"


class Case(NamedTuple):
    row: int
    what: str
    then: str
    measure: Callable


CASES = [
    Case(1, "hard poses, arms 1e-5 and 1e-6 off a closed form", "213, 254 of 300 right", near_forms),
    Case(2, "joints at zero, stretched arms", "290, 297 of 300 right",
         lambda mjarm: hard_poses(mjarm, [mjarm.write("straight.xml", mjcf(STRAIGHT)), *SHIPPED], ("zero",))),
    Case(3, "hard poses, shipped arms", "7062 of 7200 right (72 arms)", lambda mjarm: hard_poses(mjarm, SHIPPED)),
    Case(4, "ik --all, 1e-5 off a closed form", "18 of 5925 branches lost", lambda mjarm: all_branches(mjarm, 1e-5)),
    Case(4, "ik --all, six axes in general", "171 of 27948 branches lost", lambda mjarm: all_branches(mjarm, 0.1)),
    Case(5, "seventh joint, gripper of two actuators", "6 joints, no gripper", two_actuators),
    Case(5, "ctrlrange, floating base, a tool that hangs by nothing", "2 of 6, not found, told", model_faults),
    Case(6, "home 0.2 mm from a wall", "in collision", lambda mjarm: near_home(mjarm, 0.0002)),
    Case(6, "home 5 mm from a wall", "in collision", lambda mjarm: near_home(mjarm, 0.005)),
    Case(7, "grasp of a can, fingers open", "refused: overlaps by 33.94 mm", grasp),
    Case(8, "goal or start that touches, processors", "35 s, 66 s", touching),
    Case(8, "SIGINT in a search", "over 90 s", lambda mjarm: stopped(mjarm, signal.SIGINT)),
    Case(8, "SIGTERM in a search", "over 90 s", lambda mjarm: stopped(mjarm, signal.SIGTERM)),
    Case(9, "regions as goals", "16 draws; one; no turn", regions),
    Case(9, "a door as what is kept", "none", door),
    Case(10, "durations over those of sscbirrt, without / with jerk", "1.11 (1.03 to 1.42)", durations),
    Case(11, "goal in a winding out of reach", "6.9 s, nothing said", winding),
    Case(11, "demo square with what touches", "no pair, no --allow", square),
    Case(11, "start beyond ctrlrange, floating base, small arm", "97 mm off; no word; missed", told),
]


def measured(case, mjarm):
    """A row of the table: number, what, then, now, and "ok", "SKIPPED" or what is wrong."""
    try:
        now, outcome = case.measure(mjarm), "ok"
    except Absent as why:
        now, outcome = str(why), "SKIPPED"
    except Wrong as why:
        now, outcome = "-", f"WRONG: {why}"
    except (LookupError, TypeError, ValueError, OSError, StopIteration, subprocess.TimeoutExpired) as why:  # no answer, or none that can be read
        now, outcome = "-", f"WRONG: {why!r}"
    return str(case.row), case.what, case.then, now, outcome


def table(rows):
    rows = [("row", "what", "then", "now", ""), *rows]
    widths = [max(map(len, column)) for column in zip(*rows)]
    lines = ["| " + " | ".join(f"{cell:{width}}" for cell, width in zip(row, widths)) + " |" for row in rows]
    return [lines[0], "|" + "|".join("-" * (width + 2) for width in widths) + "|", *lines[1:]]


def counts(rows):
    passed, skipped = (sum(row[-1] == outcome for row in rows) for outcome in ("ok", "SKIPPED"))
    return f"{passed} {len(rows) - passed - skipped} {skipped}"


def has_sscbirrt(environment):
    python = environment / "bin" / "python"
    return python.exists() and subprocess.run([python, "-c", "import sscbirrt"], capture_output=True, check=False).returncode == 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", required=True, type=pathlib.Path)
    parser.add_argument("--peers", type=pathlib.Path)
    parser.add_argument("--row", type=int, help="this row alone")
    options = parser.parse_args()
    peers = options.peers.resolve() if options.peers and has_sscbirrt(options.peers) else None
    with tempfile.TemporaryDirectory() as folder:
        rows = [measured(case, Mjarm(options.program.resolve(), folder, peers)) for case in CASES if options.row in (None, case.row)]
    print("\n".join(table(rows)))
    print(counts(rows))


if __name__ == "__main__":
    main()
