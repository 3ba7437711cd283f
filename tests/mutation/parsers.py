"""Every reader of files in the program: what it is given, and what has to be true of what it answers."""
import gzip
import io
import json
import math
import pathlib
import struct
import zipfile
import zlib
from dataclasses import dataclass, field

import arms
from mutate import mutate
from run import NotStrict, strict_json

ROOT = pathlib.Path(__file__).resolve().parents[2]


def nothing_more(given, result):
    return ()


@dataclass
class Parser:
    name: str
    kind: str                    # of mutate.KINDS
    file: str                    # what the input is called
    seeds: list                  # good inputs
    arguments: list              # of the program
    check: callable = nothing_more  # gives what is wrong with the answer
    made: list = field(default_factory=list)  # files that it may write
    change: callable = mutate    # (data, kind, random generator) -> data

    def input(self, rng):
        return self.change(rng.choice(self.seeds), self.kind, rng)


def answers_of(given, result, name):
    """Pairs of requests and answers, line by line, of input that was all taken."""
    requests = [line for line in given.split(b"\n") if line.strip()]
    answers = (result.made(name) or b"").splitlines()
    if len(answers) != len(requests):
        return [], [f"{len(answers)} answers to {len(requests)} requests"]
    pairs, faults = [], []
    for request, answer in list(zip(requests, answers))[:2000]:
        try:
            pairs.append((strict_json(request), strict_json(answer)))
        except ValueError as error:
            faults.append(f"taken for JSON: {error}")
    return pairs, faults


def strict(name=None):
    """What the program prints, or writes, is a document of JSON."""

    def check(given, result):
        text = result.out if name is None else result.made(name)
        if not text:
            return ["no document"] if result.code == 0 else []
        try:
            strict_json(text)
        except ValueError as error:
            return [f"no JSON: {error}"]
        return []

    return check


def check_fk(given, result):
    if result.code != 0:
        return []
    pairs, faults = answers_of(given, result, "out")
    for request, answer in pairs:
        q = request["q"]
        if max(map(abs, q)) < 1e3:
            X = arms.ur5e(q)
            if max(arms.apart(X, answer["pos"], answer["quat"])) > 1e-7:
                faults.append(f"wrong pose for {q}")
    return faults


def beyond_limits(q):
    return any(abs(x) > most + 1e-9 for x, most in zip(q, arms.UR5E_LIMITS))


def check_ik(given, result):
    if result.made("out") is None:
        return []
    pairs, faults = answers_of(given, result, "out")
    for request, answer in pairs:
        if not answer["ok"]:
            continue
        p, r = arms.apart(arms.ur5e(answer["q"]), request["pos"], request["quat"])
        if p > 1.1e-4 or r > 1.1e-3 or beyond_limits(answer["q"]):
            faults.append(f"wrong answer {answer['q']}: {p} m, {r} rad off")
    return faults


def check_path(given, result):
    if result.made("out") is None:
        return []
    pairs, faults = answers_of(given, result, "out")
    for request, answer in pairs:
        if not answer["ok"]:
            continue
        rows, poses = answer["q"], request.get("poses")
        ends = {"line": ("from", "to"), "arc": ("from", "to")}.get(request["type"])
        if ends:
            rows, poses = [rows[0], rows[-1]], [request[ends[0]], request[ends[1]]]
        if any(beyond_limits(row) for row in rows):
            faults.append("a row is beyond the limits")
        if poses and len(rows) != len(poses):
            faults.append(f"{len(rows)} rows for {len(poses)} poses")
        for row, pose in zip(rows, poses or []):
            if max(arms.apart(arms.ur5e(row), pose["pos"], pose["quat"])) > 1.1e-3:
                faults.append(f"wrong row {row}")
    return faults


def overshoots(case, limits):
    """Whether it starts beyond a limit or cannot but pass one; then it may, as it is documented."""
    dof = len(limits["v"])
    states = zip(case.get("v0", [0] * dof), case.get("a0", [0] * dof), limits["v"], limits["a"], limits["j"])
    return any(abs(a) > a_max or abs(v) > v_max or abs(v + a * abs(a) / (2 * j)) > v_max for v, a, v_max, a_max, j in states)


def check_time(given, result):
    if result.made("out") is None:
        return []
    try:
        file, answers = strict_json(given), strict_json(result.made("out"))
    except NotStrict as error:
        return [f"taken for JSON: {error}"]
    faults = []
    for case in file["cases"]:
        answer = answers[str(case["id"])]
        samples = answer.get("samples") if answer["ok"] else None
        if not samples or overshoots(case, file["limits"]):
            continue
        size = max(1.0, *map(abs, case["q0"] + case["q1"]))
        for sample, goal in ((samples[0], case["q0"]), (samples[-1], case["q1"])):
            if max(abs(a - b) for a, b in zip(sample[1], goal)) > 1e-6 * size:
                faults.append(f"{case['id']}: begins or ends at {sample[1]}")
        for _, _, v, a in samples:
            for values, limits in ((v, file["limits"]["v"]), (a, file["limits"]["a"])):
                if any(abs(x) > most * (1 + 1e-6) + 1e-12 for x, most in zip(values, limits)):
                    faults.append(f"{case['id']}: {values} is beyond {limits}")
    return faults[:3]


ARM = {"name": "arm", "base": "base", "joint_names": ["j1", "j2"], "self_collision_link_pairs": [],
       "joints": [{"name": "j1", "type": "revolute", "parent": "base", "child": "a", "xyz": [0, 0, 0], "quat": [1, 0, 0, 0],
                   "axis": [0, 0, 1], "limits": [-3, 3]},
                  {"name": "j2", "type": "revolute", "parent": "a", "child": "b", "xyz": [1, 0, 0], "quat": [1, 0, 0, 0],
                   "axis": [0, 0, 1], "limits": [-3, 3]}],
       "spheres": [{"link": "b", "center": [1, 0, 0], "radius": 0.1}]}
PROBLEM = {"id": "p", "scene": "one", "start": [-0.8, 0], "goals": [[0.8, 0], [1.2, 0.1]], "valid": True,
           "obstacles": [{"name": "ball", "type": "sphere", "pos": [2, 0, 0], "radius": 0.3},
                         {"name": "box", "type": "box", "pos": [-2, 0, 0], "quat": [1, 0, 0, 0], "half": [0.2, 0.1, 0.3]}]}
PROBLEMS = json.dumps({"robot": ARM, "problems": [PROBLEM]}).encode()
PATHS = json.dumps({"p": {"ok": True, "path": [[-0.8, 0], [-0.8, 1.5], [0.8, 1.5], [0.8, 0]]}}).encode()


def path_faults(problem, path):
    """Of the planar arm of the seeds, with balls in its way."""
    if max(map(abs, (a - b for a, b in zip(path[0], problem["start"])))) > 1e-4:
        yield f"begins at {path[0]}"
    if min(max(abs(a - b) for a, b in zip(path[-1], goal)) for goal in problem["goals"]) > 1e-4:
        yield f"ends at {path[-1]}"
    balls = [ball for ball in problem["obstacles"] if ball["type"] == "sphere"]
    for a, b in zip(path, path[1:]):
        steps = 1 + int(min(1e4, max(abs(x - y) for x, y in zip(a, b)) / 0.02))
        for i in range(steps + 1):
            p = arms.planar([x + (y - x) * i / steps for x, y in zip(a, b)])
            for ball in balls:
                if math.dist(p, ball["pos"]) < ball["radius"] + ARM["spheres"][0]["radius"] - 1e-4:
                    yield f"hits {ball['name']} at {p}"


def problems_of(packed):
    # As zlib reads it: what comes after the end is nobody's, and a file that is no gzip is plain.
    plain = zlib.decompressobj(31).decompress(packed) if packed[:2] == b"\x1f\x8b" else packed
    file = strict_json(plain)
    same = file["robot"]["joints"] == ARM["joints"] and file["robot"]["spheres"] == ARM["spheres"]
    return {problem["id"]: problem for problem in file["problems"]} if same else {}


def check_plan(given, result):
    if not result.made("out"):
        return []
    try:
        problems, answers = problems_of(given), strict_json(result.made("out"))
    except NotStrict as error:
        return [f"taken for JSON: {error}"]
    return [f"{name}: {fault}" for name, problem in problems.items() if answers[name]["ok"]
            for fault in path_faults(problem, answers[name]["path"])][:3]


def check_verify(given, result):
    if result.code != 0:
        return []
    try:
        answers = strict_json(given)
    except ValueError as error:
        return [f"taken for JSON: {error}"]
    answer = answers["p"]
    path = answer["path"] if isinstance(answer, dict) else answer
    return [f"called valid: {fault}" for fault in path_faults(PROBLEM, path)][:3]


def check_report(given, result):
    report = result.made("out/report.json")
    if report is None:
        return ["no report"] if result.code == 0 else []
    success = strict_json(report).get("success")
    return [] if success is not None and 0 <= success <= 1 else [f"success of {success}"]


def pack(change):
    """The content is changed before it is packed, or now and then what is packed."""

    def changed(data, kind, rng):
        if rng.random() < 0.15:
            return change(gzip.compress(data, mtime=0), "bytes", rng)
        return gzip.compress(change(data, kind, rng), compresslevel=1, mtime=0)

    return changed


def change_safetensors(data, kind, rng):
    """The header, with its length right or not; the numbers, also those that are none; or any byte."""
    size = struct.unpack("<Q", data[:8])[0]
    header, numbers = data[8 : 8 + size], data[8 + size :]
    where = rng.random()
    if where < 0.6:
        header = mutate(header, "json", rng)
        length = len(header) if rng.random() < 0.8 else rng.choice([0, 1, 2**31, 2**63, 2**64 - 1, len(header) + 1])
        return struct.pack("<Q", length) + header + numbers
    if where < 0.9:
        changed = bytearray(numbers)
        for _ in range(rng.choice([1, 3, 100])):
            at = 4 * rng.randrange(len(changed) // 4)
            changed[at : at + 4] = struct.pack("<f", rng.choice([math.inf, -math.inf, math.nan, 3e38, -1e30, 0, 1e-40]))
        return data[: 8 + size] + bytes(changed)
    return mutate(data, "bytes", rng)


def change_zip(data, kind, rng):
    """One of its members, packed again as it was; or any byte."""
    if rng.random() < 0.3:
        return mutate(data, "bytes", rng)
    source, target = zipfile.ZipFile(io.BytesIO(data)), io.BytesIO()
    chosen = rng.choice(source.namelist())
    with zipfile.ZipFile(target, "w") as out:
        for info in source.infolist():
            content = source.read(info)
            if info.filename == chosen:
                if content[:2] == b"PK":  # PyTorch's file, a zip as well
                    content = change_zip(content, kind, rng)
                else:
                    content = mutate(content, rng.choice(["bytes", "json"]), rng)
            if info.filename != chosen or rng.random() < 0.95:
                out.writestr(zipfile.ZipInfo(info.filename), content, rng.choice([info.compress_type] * 5 + [zipfile.ZIP_DEFLATED]))
    return target.getvalue()


def change_words(data, kind, rng):
    """Lines, each an argument of the command line: no zero byte can be in one, and none is longer than the system lets it."""
    return mutate(data, "words", rng).replace(b"\x00", b"")[:100000]


def lines(*objects):
    return [json.dumps(entry).encode() + b"\n" for entry in objects]


def together(seeds):
    return seeds + [b"".join(seeds)]


def files(*patterns):
    return [path.read_bytes() for pattern in patterns for path in sorted(ROOT.glob(pattern))]


DOWN = [0, 1, 0, 0]


def pose(x, y, z):
    return {"pos": [x, y, z], "quat": DOWN}


MJCF = b"""<mujoco model="m"><option timestep="0.002"/><default><geom density="500"/></default><asset>
<texture name="t" type="2d" builtin="checker" width="8" height="8"/><material name="m" texture="t"/></asset><worldbody>
<light pos="0 0 3"/><geom type="plane" size="1 1 .1"/><body name="a" pos="0 0 .5"><joint name="j" axis="0 0 1" range="-2 2"/>
<geom type="capsule" size=".05" fromto="0 0 0 .4 0 0"/><body name="b" pos=".4 0 0"><joint name="k" axis="0 1 0" range="-2 2"/>
<geom type="box" size=".1 .05 .05" material="m"/><site name="tip" pos=".1 0 0"/></body></body></worldbody><actuator>
<position joint="j" kp="50"/><position joint="k" kp="50"/></actuator><keyframe><key name="home" qpos="0 0.5" ctrl="0 0.5"/></keyframe>
</mujoco>"""
URDF = b"""<robot name="r"><link name="base"/><link name="a"><inertial><origin xyz="0 0 .2"/><mass value="1"/><inertia ixx=".1" iyy=".1"
izz=".1" ixy="0" ixz="0" iyz="0"/></inertial><collision><geometry><cylinder radius=".05" length=".4"/></geometry></collision></link>
<link name="b"><visual><origin xyz="0 0 .1" rpy="0 1 0"/><geometry><box size=".1 .1 .2"/></geometry></visual></link>
<joint name="j" type="revolute"><parent link="base"/><child link="a"/><axis xyz="0 0 1"/><limit lower="-2" upper="2" velocity="1"
effort="5"/></joint><joint name="k" type="revolute"><origin xyz="0 0 .4" rpy="1.57 0 0"/><parent link="a"/><child link="b"/>
<axis xyz="0 1 0"/><limit lower="-1" upper="1" velocity="1" effort="5"/><dynamics damping="1" friction="1"/></joint></robot>"""


def all_parsers():
    policies = files("models/policies/*.safetensors")
    small = {"limits": {"v": [1, 2], "a": [5, 4], "j": [20, 40]}, "cases": []}
    case = {"id": "c", "q0": [0, 1], "q1": [1, -1], "v0": [0.1, 0], "v1": [0, 0], "a0": [0, 0], "a1": [0, 0]}
    times = [json.dumps({**small, "cases": cases}).encode() for cases in ([case], [case, {"id": 7, "q0": [0, 0], "q1": [0.02, 3]}])]
    return [
        Parser("fk", "lines", "in.jsonl", together(lines({"q": [0, -1.57, 1.57, -1.57, -1.57, 0]}, {"q": [1, 2, -1, 0.5, 3, -2]})),
               ["fk", "--robot", "ur5e", "--in", "in.jsonl", "--out", "out"], check_fk, ["out"]),
        Parser("ik", "lines", "in.jsonl", together(lines(pose(0.3, 0.4, 0.4), {**pose(-0.2, 0.5, 0.2), "seed": [0, -1, 1, -1, -1, 0]})),
               ["ik", "--robot", "ur5e", "--in", "in.jsonl", "--out", "out"], check_ik, ["out"]),
        Parser("path", "lines", "in.jsonl", together(lines(
            {"type": "poses", "poses": [pose(0.3, 0.4, 0.4), pose(0.3, 0.41, 0.4)], "start": [0, -1.57, 1.57, -1.57, -1.57, 0]},
            {"type": "line", "from": pose(0.3, 0.4, 0.4), "to": pose(0.2, 0.4, 0.4), "max_step": 0.1},
            {"type": "polyline", "points": [pose(0.3, 0.4, 0.4), pose(0.2, 0.4, 0.4), pose(0.2, 0.4, 0.5)], "blend": 0.02},
            {"type": "arc", "from": pose(0.3, 0.4, 0.4), "via": pose(0.25, 0.45, 0.4), "to": pose(0.2, 0.4, 0.4)},
            {"type": "ellipse", "center": [0, 0.45, 0.4], "a": 0.1, "b": 0.05, "normal": [0, 0, 1], "quat": DOWN, "points": 9})),
               ["path", "--robot", "ur5e", "--in", "in.jsonl", "--out", "out"], check_path, ["out"]),
        Parser("time", "json", "in.json", times,
               ["time", "--problem", "p2p", "--in", "in.json", "--out", "out", "--dt", "0.02"], check_time, ["out"]),
        Parser("plan", "json", "in.json.gz", [PROBLEMS], ["plan", "--in", "in.json.gz", "--out", "out"], check_plan, ["out"],
               pack(mutate)),
        Parser("verify", "json", "paths.json", [PATHS], ["verify", "--in", "problems.json.gz", "paths.json"], check_verify,
               ["problems.json.gz"]),
        Parser("program", "yaml", "p.yaml", files("examples/programs/*.yaml"), ["check", "p.yaml", "--json"], strict()),
        Parser("program_text", "yaml", "p.yaml", files("examples/programs/*.yaml"), ["check", "p.yaml"]),
        Parser("config", "yaml", "c.yaml", files("models/policies/*.yaml"), ["train", "reach", "--config", "c.yaml", "--print-config"]),
        Parser("policy", "bytes", "p.safetensors", policies, ["eval", "p.safetensors", "--episodes", "1", "--out", "out", "--no-timing"],
               check_report, ["out"], change_safetensors),
        Parser("sb3", "bytes", "p.zip", files("mjarm/rl/testdata/sb3_*.zip"), ["eval", "p.zip", "--episodes", "1", "--out", "out"],
               check_report, ["out"], change_zip),
        Parser("checkpoint", "bytes", "last.safetensors", policies,
               ["train", "reach", "--resume", "last.safetensors", "--print-config"], change=change_safetensors),
        Parser("mjcf", "xml", "m.xml", [MJCF], ["model", "info", "m.xml", "--json"], strict()),
        Parser("lint", "xml", "m.xml", [MJCF], ["model", "check", "m.xml"]),
        Parser("urdf", "xml", "m.urdf", [URDF], ["model", "tree", "m.urdf"]),
        Parser("words", "words", "words", [b"--pos\n0.3,0.4,0.4\n--euler\n180deg,0,90deg", b"--pos\n300mm,-0.2,0.5\n--quat\n0,1,0,0\n--all"],
               ["ik", "--robot", "ur5e"], change=change_words),
    ]


def lay_down(parser, data, folder):
    """The files of a case. Returns the arguments of the program."""
    if parser.name == "words":
        return parser.arguments + [word for word in data.split(b"\n")]
    (folder / parser.file).write_bytes(data)
    if parser.name == "verify":
        (folder / "problems.json.gz").write_bytes(gzip.compress(PROBLEMS, mtime=0))
    return parser.arguments
