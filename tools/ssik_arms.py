"""Asks for hard poses of every arm that ssik ships, joints at limits and at zero: none may be refused, none wrong.

Usage: PYTHON ssik_arms.py --program MJARM [--threads N], PYTHON being one that has ssik (./dev peers). The arms are handed over as URDF. Prints what
fails, and "PASSED FAILED SKIPPED" last: one of each is an arm.
"""

import argparse
import concurrent.futures
import importlib
import math
import os
import pathlib
import subprocess
import tempfile

INERTIAL = '<inertial><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>'


def origin(X):
    """A pose (4, 4) in URDF's words: fixed axes x, y, z by roll, pitch, yaw."""
    pitch = math.atan2(-X[2][0], math.hypot(X[0][0], X[1][0]))
    if abs(math.cos(pitch)) < 1e-9:
        roll, yaw = 0.0, math.atan2(-X[0][1], X[1][1])
    else:
        roll, yaw = math.atan2(X[2][1], X[2][2]), math.atan2(X[1][0], X[0][0])
    return f'<origin xyz="{words(row[3] for row in X[:3])}" rpy="{words((roll, pitch, yaw))}"/>'


def words(values):
    return " ".join(repr(float(value)) for value in values)


def product(A, B):
    return [[sum(A[i][k] * B[k][j] for k in range(4)) for j in range(4)] for i in range(4)]


def urdf(name, joints):
    """A chain of ssik: each joint has a fixed pose before its axis and one behind."""
    lines, parent, behind = [f'<robot name="{name}">', '<link name="base"/>'], "base", [[float(i == j) for j in range(4)] for i in range(4)]
    for number, joint in enumerate(joints, 1):
        X, child = product(behind, joint.T_left), f"link{number}"
        behind = joint.T_right
        kind, limit = joint.joint_type, ""
        if kind != "fixed" and joint.limits:
            limit = '<limit lower="{!r}" upper="{!r}" effort="100" velocity="3"/>'.format(*map(float, joint.limits))
        elif kind == "revolute":
            kind = "continuous"
        axis = "" if kind == "fixed" else f'<axis xyz="{words(joint.axis)}"/>'
        lines += [f'<link name="{child}">{INERTIAL}</link>',
                  f'<joint name="joint{number}" type="{kind}">{origin(X)}<parent link="{parent}"/><child link="{child}"/>{axis}{limit}</joint>']
        parent = child
    lines += ['<link name="tool"/>', f'<joint name="flange" type="fixed">{origin(behind)}<parent link="{parent}"/><child link="tool"/></joint>', "</robot>"]
    return "\n".join(lines)


def refused(program, file):
    """What mjarm prints where a pose is refused or wrong, else nothing."""
    done = subprocess.run([program, "--lang", "en", "bench", "ik", "--hard", "--rounds", "1", "--no-timing", "--quiet", "--robot", file],
                          capture_output=True, text=True, check=False)
    return "" if done.returncode == 0 else done.stdout + done.stderr or f"{file}: exit code {done.returncode}\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", required=True)
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    options = parser.parse_args()
    ssik = importlib.import_module("ssik")
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(options.threads) as pool:
        files = []
        for arm in ssik.list_arms():
            files.append(pathlib.Path(folder, f"{arm.vendor}_{arm.name}.urdf"))
            files[-1].write_text(urdf(arm.name, ssik.Manipulator.from_prebuilt(arm.name).kinbody.joints), encoding="utf-8")
        said = list(pool.map(lambda file: refused(options.program, file), files))
    print("".join(said), end="")
    print(sum(not one for one in said), sum(bool(one) for one in said), 0)


if __name__ == "__main__":
    main()
