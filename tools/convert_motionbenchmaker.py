#!/usr/bin/env python3
"""Converts the MotionBenchMaker problems into files for `mjarm plan --in` and `mjarm bench plan`.

The public source is GitHub KavrakiLab/vamp (Apache-2.0), which ships them for some robots in the folders
resources/panda and resources/ur5: problems.tar.bz2, ROBOT_spherized.urdf and ROBOT.srdf. They come from
KavrakiLab/motion_bench_maker (BSD-3-Clause, (c) 2021 Rice University). Needs PyYAML.

    git clone --depth 1 https://github.com/KavrakiLab/vamp
    python3 tools/convert_motionbenchmaker.py vamp/resources/panda --out mbm_panda_public.json.gz
    python3 tools/convert_motionbenchmaker.py vamp/resources/ur5 --out mbm_ur5_public.json.gz

Lengths are in metres, angles in radians, quaternions w x y z, poses in the world frame.
"""

import argparse
import gzip
import itertools
import json
import math
import pathlib
import re
import sys
import tarfile
import xml.etree.ElementTree as xml


def quat_product(a, b):
    aw, ax, ay, az = a
    bw, bx, by, bz = b
    return [aw * bw - ax * bx - ay * by - az * bz, aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx, aw * bz + ax * by - ay * bx + az * bw]


def quat_about(axis, angle):
    length = math.hypot(*axis)
    return [math.cos(angle / 2)] + [math.sin(angle / 2) * x / length for x in axis]


def turned(q, p):
    return quat_product(quat_product(q, [0.0, *p]), [q[0], -q[1], -q[2], -q[3]])[1:]


def joined(a, b):
    """Pose b in the frame that pose a places; poses are (position, quaternion)."""
    return ([x + y for x, y in zip(a[0], turned(a[1], b[0]))], quat_product(a[1], b[1]))


def numbers(text, default):
    return [float(x) for x in text.split()] if text else default


def pose_of(element):
    """<origin> of URDF."""
    origin = element.find("origin")
    at = origin.attrib if origin is not None else {}
    roll, pitch, yaw = numbers(at.get("rpy"), [0.0] * 3)
    q = quat_product(quat_about([0, 0, 1], yaw),
                     quat_product(quat_about([0, 1, 0], pitch), quat_about([1, 0, 0], roll)))
    return numbers(at.get("xyz"), [0.0] * 3), q


def joint_entry(joint):
    xyz, quat = pose_of(joint)
    out = {"name": joint.get("name"), "type": joint.get("type"), "parent": joint.find("parent").get("link"),
           "child": joint.find("child").get("link"), "xyz": xyz, "quat": quat}
    if out["type"] == "fixed":
        return out
    axis, limit = joint.find("axis"), joint.find("limit")
    out["axis"] = numbers(axis.get("xyz") if axis is not None else None, [1.0, 0.0, 0.0])
    out["limits"] = [float(limit.get("lower")), float(limit.get("upper"))]
    out["velocity"] = float(limit.get("velocity"))
    return out


def parents_first(joints, base):
    out, known, left = [], {base}, list(joints)
    while left:
        ready = [j for j in left if j["parent"] in known]
        if not ready:
            raise ValueError("joints whose parents are unknown: " + ", ".join(j["name"] for j in left))
        out.append(ready[0])
        known.add(ready[0]["child"])
        left.remove(ready[0])
    return out


def read_robot(folder):
    urdf = xml.parse(folder / f"{folder.name}_spherized.urdf").getroot()
    joints = [joint_entry(j) for j in urdf.findall("joint")]
    children = {j["child"] for j in joints}
    base = next(link.get("name") for link in urdf.findall("link") if link.get("name") not in children)
    joints = parents_first(joints, base)
    spheres = []
    for link in urdf.findall("link"):
        for collision in link.findall("collision"):
            ball = collision.find("geometry/sphere")
            if ball is not None:
                spheres.append({"link": link.get("name"), "center": pose_of(collision)[0],
                                "radius": float(ball.get("radius"))})
    moving = [j for j in joints if j["type"] != "fixed"]
    srdf = xml.parse(folder / f"{folder.name}.srdf").getroot()
    return {"name": folder.name, "base": base, "joint_names": [j["name"] for j in moving],
            "lower": [j["limits"][0] for j in moving], "upper": [j["limits"][1] for j in moving],
            "joints": joints, "spheres": spheres,
            "self_collision_link_pairs": link_pairs(srdf, base, joints, spheres)}


def link_pairs(srdf, base, joints, spheres):
    """What can touch: links with spheres, with two joints between them at least, but what the SRDF allows."""
    allowed = {frozenset((e.get("link1"), e.get("link2"))) for e in srdf.findall("disable_collisions")}
    moved_by, beside = {base: base}, set()
    for joint in joints:
        before = moved_by[joint["parent"]]
        moved_by[joint["child"]] = before if joint["type"] == "fixed" else joint["name"]
        beside.add(frozenset((before, moved_by[joint["child"]])))
    with_spheres = {s["link"] for s in spheres}
    links = [link for link in [base] + [j["child"] for j in joints] if link in with_spheres]
    return [[a, b] for a, b in itertools.combinations(links, 2)
            if frozenset((moved_by[a], moved_by[b])) not in beside | {frozenset((moved_by[a],))}
            and frozenset((a, b)) not in allowed]


def moveit_pose(entry):
    x, y, z, w = entry["orientation"]
    length = math.hypot(w, x, y, z)
    return list(map(float, entry["position"])), [w / length, x / length, y / length, z / length]


def read_obstacle(entry, scene):
    shape = entry["primitives"][0]
    pose = moveit_pose(entry["primitive_poses"][0])
    if "pose" in entry:
        pose = joined(moveit_pose(entry["pose"]), pose)
    out = {"name": entry["id"], "type": shape["type"], "pos": pose[0], "quat": pose[1]}
    size = [float(x) for x in shape["dimensions"]]
    if shape["type"] == "box":
        out["half"] = [x / 2 for x in size]
    elif shape["type"] == "cylinder":
        # What VAMP puts in its place: to be compared with it, the same solids have to be meant.
        out.update(length=size[0], radius=size[1], vamp_as="box" if scene == "box" else "capsule")
    elif shape["type"] == "sphere":
        out["radius"] = size[0]
    else:
        raise ValueError(f"{entry['id']}: unknown shape {shape['type']}")
    return out


def read_request(entry, names):
    state = entry["start_state"]["joint_state"]
    start = dict(zip(state["name"], state["position"]))
    goals = []
    for goal in entry["goal_constraints"]:
        values = {c["joint_name"]: c["position"] for c in goal["joint_constraints"]}
        goals.append([float(values[name]) for name in names])
    return [float(start[name]) for name in names], goals


class Checker:
    """Whether a configuration is free, by distances of spheres: which problems count."""

    def __init__(self, robot):
        self.robot = robot

    def places(self, q):
        values = dict(zip(self.robot["joint_names"], q))
        poses = {self.robot["base"]: ([0.0] * 3, [1.0, 0.0, 0.0, 0.0])}
        for joint in self.robot["joints"]:
            pose = joined(poses[joint["parent"]], (joint["xyz"], joint["quat"]))
            value = values.get(joint["name"], 0.0)
            if joint["type"] == "prismatic":
                pose = joined(pose, ([value * x for x in joint["axis"]], [1.0, 0.0, 0.0, 0.0]))
            elif joint["type"] != "fixed":
                pose = joined(pose, ([0.0] * 3, quat_about(joint["axis"], value)))
            poses[joint["child"]] = pose
        out = {}
        for sphere in self.robot["spheres"]:
            pose = poses[sphere["link"]]
            center = [x + y for x, y in zip(pose[0], turned(pose[1], sphere["center"]))]
            out.setdefault(sphere["link"], []).append((center, sphere["radius"]))
        return out

    @staticmethod
    def distance(obstacle, p):
        q = obstacle["quat"]
        p = turned([q[0], -q[1], -q[2], -q[3]], [a - b for a, b in zip(p, obstacle["pos"])])
        if obstacle["type"] == "sphere":
            return math.hypot(*p) - obstacle["radius"]
        if obstacle.get("vamp_as") == "capsule":
            beyond = max(abs(p[2]) - obstacle["length"] / 2, 0.0)
            return math.hypot(p[0], p[1], beyond) - obstacle["radius"]
        r, h = obstacle.get("radius", 0), obstacle.get("length", 0) / 2
        half = obstacle["half"] if obstacle["type"] == "box" else [r, r, h]
        return math.hypot(*(max(abs(x) - s, 0.0) for x, s in zip(p, half)))

    def is_free(self, q, obstacles):
        limits = zip(q, self.robot["lower"], self.robot["upper"])
        if any(not low - 1e-9 <= x <= high + 1e-9 for x, low, high in limits):
            return False
        places = self.places(q)
        spheres = [s for link in places.values() for s in link]
        if any(self.distance(o, p) <= r for o in obstacles for p, r in spheres):
            return False
        return all(math.dist(p, u) > r + s for a, b in self.robot["self_collision_link_pairs"]
                   for p, r in places.get(a, []) for u, s in places.get(b, []))


def read_problems(folder, robot, yaml):
    """Pairs of files problems/SCENE_ROBOT/sceneNNNN.yaml and requestNNNN.yaml, by scene and number."""
    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    pairs = {}
    with tarfile.open(folder / "problems.tar.bz2") as archive:
        for member in archive:
            found = re.search(r"([^/]+)/(scene|request)(\d+)\.yaml$", member.name)
            if not member.isfile() or not found:
                continue
            scene = found[1].removesuffix("_" + robot["name"])
            content = yaml.load(archive.extractfile(member).read(), Loader=loader)
            pairs.setdefault((scene, int(found[3])), {})[found[2]] = content
    checker = Checker(robot)
    problems = []
    for (scene, index), pair in sorted(pairs.items()):
        if len(pair) != 2:
            continue
        start, goals = read_request(pair["request"], robot["joint_names"])
        obstacles = [read_obstacle(o, scene) for o in pair["scene"]["world"]["collision_objects"]]
        start_free = checker.is_free(start, obstacles)
        goals_free = [checker.is_free(goal, obstacles) for goal in goals]
        problems.append({"id": f"{robot['name']}/{scene}/{index:04d}", "scene": scene, "index": index,
                         "start": start, "goals": goals, "obstacles": obstacles,
                         "valid": start_free and any(goals_free), "start_free": start_free,
                         "goals_free": goals_free})
    return problems


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path, help="resources/ROBOT of KavrakiLab/vamp")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="the file to write, *.json or *.json.gz")
    args = parser.parse_args()
    try:
        import yaml
    except ImportError:
        sys.exit("convert_motionbenchmaker: needs PyYAML (Debian/Ubuntu: apt-get install python3-yaml)")
    try:
        robot = read_robot(args.folder.resolve())
        problems = read_problems(args.folder, robot, yaml)
    except (OSError, ValueError, KeyError, xml.ParseError) as error:
        sys.exit(f"convert_motionbenchmaker: {args.folder}: {error}")
    content = json.dumps({"format": "mbm-neutral-1", "units": "m, rad; quat = w x y z; world frame",
                          "robot": robot, "problems": problems}, separators=(",", ":"))
    if args.out.suffix == ".gz":
        args.out.write_bytes(gzip.compress(content.encode(), mtime=0))
    else:
        args.out.write_text(content)
    valid = sum(p["valid"] for p in problems)
    print(f"{args.out}: {len(problems)} problems of {robot['name']}, {valid} of them valid")


if __name__ == "__main__":
    main()
