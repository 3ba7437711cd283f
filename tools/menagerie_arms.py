"""Tries every serial arm of MuJoCo Menagerie as a user would, and tells what fails and why.

Usage: menagerie_arms.py --program MJARM --package FOLDER [--threads N] [ROBOT...]
FOLDER holds the Python package mujoco_menagerie, whose registry names every model with its hash; it fetches
them (MENAGERIE_BASE_URL, MENAGERIE_CACHE_DIR). What cannot be fetched is skipped. The last line printed is
"PASSED FAILED SKIPPED", three numbers; one of each is a command with one arm.
"""

import argparse
import collections
import concurrent.futures
import difflib
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import urllib.error

CATEGORIES = ("arm", "dual_arm", "mobile_manipulator")

# These reach out by a telescope that one tendon drives: no serial arm.
NOT_SERIAL = ("hello_robot_stretch", "hello_robot_stretch_3")

# Beside an arm of a robot with several, shorter chains are necks and legs.
LEAST_JOINTS = 4

TIMEOUT = 300  # [s] for one command

Result = collections.namedtuple("Result", "robot tip what reason")  # reason: empty = all is well

STEPS = ("model check", "ik", "hard poses", "demo square", "plan", "run", "render")


class Absent(Exception):
    """This model cannot be had here, which is no fault of anybody's."""


class Broken(Exception):
    """What was fetched is not what was asked for."""


class Arm:
    """One arm of a file, and what mjarm says of it."""

    def __init__(self, program, robot, file, tip, about, folder):
        self.program, self.robot, self.file, self.tip, self.folder = program, robot, file, tip, folder
        self.about = about
        joints = about["arm"]["joints"]
        self.home = about["arm"]["home"]
        self.goal = [self.near_home(q, *joint["position"]) for q, joint in zip(self.home, joints)]

    @staticmethod
    def near_home(q, lower, upper):
        """A tenth of a radian or meter off `q`, or less where the range is short, towards its middle."""
        if lower is None or upper is None:
            return q + 0.1
        step = min(0.1, (upper - lower) / 8)
        return q + (step if q < (lower + upper) / 2 else -step)

    def run(self, *words):
        return mjarm(self.program, *words)

    def on_arm(self, *words):
        """With `--robot` and `--tip`."""
        tip = ("--tip", self.tip) if self.tip else ()
        return self.run(*words, "--robot", str(self.file), *tip)

    def reason_of_check(self):
        tip = ("--tip", self.tip) if self.tip else ()
        return reason(self.run("model", "check", str(self.file), *tip))

    def reason_of_ik(self):
        found = self.on_arm("fk", "--q", numbers(self.goal))
        if found.returncode != 0:
            return reason(found)
        pose = json.loads(found.stdout)
        return reason(self.on_arm("ik", "--pos", numbers(pose["pos"]), "--quat", numbers(pose["quat"])))

    def reason_of_hard_poses(self):
        return reason(self.on_arm("bench", "ik", "--hard", "--rounds", "1", "--no-timing", "--quiet"))

    def reason_of_square(self):
        return reason(self.on_arm("demo", "square", "--headless", "--no-timing", "--out", str(self.folder / "square")))

    def reason_of_plan(self):
        out = str(self.folder / "path.json")
        return reason(self.on_arm("plan", "--goal", numbers(self.goal), "--no-timing", "--out", out))

    def reason_of_run(self):
        program = {"robot": str(self.file), "program": [{"movej": {"joints": self.goal}}, {"wait": 0.1},
                                                        {"movej": {"joints": self.home}}]}
        if self.tip:
            program["tool"] = self.tip
        file = self.folder / "there_and_back.yaml"
        file.write_text(json.dumps(program), encoding="utf-8")  # JSON is YAML
        return reason(self.run("run", str(file), "--headless", "--no-timing", "--out", str(self.folder / "run")))

    def reason_of_render(self):
        picture = self.folder / "arm.png"
        why = reason(self.run("render", str(self.file), "--size", "320x240", "--out", str(picture)))
        return why or ("" if picture.exists() else "there is no picture")

    def results(self):
        steps = (self.reason_of_check, self.reason_of_ik, self.reason_of_hard_poses, self.reason_of_square,
                 self.reason_of_plan, self.reason_of_run, self.reason_of_render)
        for what, step in zip(STEPS, steps):
            yield Result(self.robot, self.tip, what, step())


def mjarm(program, *words):
    command = [program, "--lang", "en", *words]
    try:
        return subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=TIMEOUT,
                              check=False)
    except subprocess.TimeoutExpired:
        return subprocess.CompletedProcess(command, 124, "", f"it took over {TIMEOUT} s")


def numbers(values):
    return ",".join(repr(value) for value in values)


def reason(ran):
    """Empty where a command did what it was asked for, else its last words."""
    if ran.returncode == 0:
        return ""
    lines = [line for line in (ran.stderr or ran.stdout).splitlines() if line and not line.startswith("files in")]
    return lines[-1] if lines else f"exit code {ran.returncode}"


def about(program, file, tip=""):
    """What `model info` says; an error as its last words."""
    ran = mjarm(program, "model", "info", str(file), "--json", *(("--tip", tip) if tip else ()))
    return json.loads(ran.stdout) if ran.returncode == 0 else {"arm": None, "no_arm": reason(ran)}


def arms_of(program, robot, file, folder):
    """Every arm of a file, each under the first tip that names it; none and why where there is none."""
    said = about(program, file)
    if said["arm"]:
        return [Arm(program, robot, file, "", said, folder)], ""
    if "; choose one" not in said["no_arm"]:
        return [], said["no_arm"]
    arms, known = [], set()
    for tip in said["no_arm"].rpartition(": ")[2].split(", "):
        one = about(program, file, tip)
        joints = tuple(joint["name"] for joint in one["arm"]["joints"]) if one["arm"] else ()
        if len(joints) < LEAST_JOINTS or joints in known:
            continue
        known.add(joints)
        arms.append(Arm(program, robot, file, tip, one, folder))
    return arms, "" if arms else said["no_arm"]


def try_robot(program, robot, file):
    """All results of one robot."""
    with tempfile.TemporaryDirectory() as scratch:
        arms, why = arms_of(program, robot, file, pathlib.Path(scratch))
        results = [] if arms else [Result(robot, "", what, why) for what in STEPS]
        for k, arm in enumerate(arms):
            arm.folder = pathlib.Path(scratch) / str(k)
            arm.folder.mkdir()
            results += arm.results()
    folder_name = str(pathlib.Path(file).parent) + "/"
    return [one._replace(reason=one.reason.replace(folder_name, "")) for one in results]


def try_all(program, robots, fetch, threads):
    """Results of all robots that can be had, and the reasons and names of those that cannot.

    robots: their names. fetch(name): the file of its scene, or Absent, or Broken.
    """
    files, results, absent = {}, [], collections.defaultdict(list)
    for robot in robots:
        try:
            files[robot] = fetch(robot)
        except Absent as why:
            absent[str(why)].append(robot)
        except Broken as why:
            results += [Result(robot, "", what, str(why)) for what in STEPS]
    with concurrent.futures.ThreadPoolExecutor(threads) as pool:
        for some in pool.map(lambda item: try_robot(program, *item), files.items()):
            results += some
    return results, absent


def table(results):
    """One line a command: robot, what, ok or the reason."""
    rows = [(f"{r.robot} ({r.tip})" if r.tip else r.robot, r.what, r.reason or "ok") for r in results]
    widths = [max((len(row[i]) for row in rows), default=0) for i in range(2)]
    return [f"{robot:{widths[0]}}  {what:{widths[1]}}  {outcome}" for robot, what, outcome in rows]


def from_package(folder):
    """Names of the serial arms of the package in `folder`, and how to fetch one."""
    sys.path.insert(0, str(folder))
    import mujoco_menagerie as menagerie  # only now is it known where it is

    known = {robot.name: robot for category in CATEGORIES for robot in menagerie.robots(category)
             if robot.name not in NOT_SERIAL}
    cache = menagerie.Cache()
    unreachable = f"{cache.base_url} cannot be reached (MENAGERIE_BASE_URL names another place)"
    down = []

    def fetch(name):
        if down and not cache.is_cached(known[name]):
            raise Absent(unreachable)
        try:
            return known[name].xml(cache=cache)
        except menagerie.ChecksumError as error:
            raise Broken(str(error)) from error
        except menagerie.DownloadError as error:
            if isinstance(error.__cause__, urllib.error.HTTPError) or str(error).endswith(": not found"):
                raise Absent(f"{cache.base_url} does not have it") from error
            down.append(name)
            raise Absent(unreachable) from error

    return sorted(known), fetch


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", required=True)
    parser.add_argument("--package", required=True, type=pathlib.Path)
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("robots", nargs="*")
    arguments = parser.parse_args()
    robots, fetch = from_package(arguments.package)
    for robot in arguments.robots:
        if robot not in robots:
            near = difflib.get_close_matches(robot, robots, 1)
            hint = f" (did you mean {near[0]}?)" if near else ""
            parser.exit(2, f'there is no serial arm "{robot}" in Menagerie{hint}; arms: {", ".join(robots)}\n')
    results, absent = try_all(arguments.program, arguments.robots or robots, fetch, arguments.threads)
    for row in table(results):
        print(row)
    for why, names in absent.items():
        print(f"SKIPPED: {len(names)} robots of Menagerie ({names[0]}{', ...' if names[1:] else ''}): {why}")
    passed = sum(not result.reason for result in results)
    print(passed, len(results) - passed, len(STEPS) * sum(map(len, absent.values())))


if __name__ == "__main__":
    main()
