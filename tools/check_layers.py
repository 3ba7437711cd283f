"""Checks that the rooms of mjarm stay apart as they should.

Usage: check_layers.py [ROOT]. Prints one line a fault; exit code 1 when there is one.
"""

import fnmatch
import pathlib
import re
import sys

# Which rooms a room may include, in the order in which data flows. This is the one place.
ALLOWED = {
    "core": "",
    "model": "core",
    "kinematics": "core model",
    "collision": "core model kinematics",
    "path": "core model kinematics collision",
    "planning": "core model kinematics collision path",
    "trajectory": "core model kinematics path",
    "control": "core model kinematics trajectory",
    "identification": "core model kinematics path trajectory control",
    "sim": "core model control",
    "teleop": "core model kinematics collision trajectory control sim",
    "render": "core model sim",
    "perception": "core model sim render",
    "execution": "core model kinematics collision path planning trajectory control sim",
    "program": "core model kinematics collision path planning trajectory control identification sim execution",
    "view": "core model sim render",
    "serve": "core model sim render view",
    "rl": "core model kinematics control sim",
    "episode": "core model kinematics collision path planning trajectory control sim render execution program",
    "clone": "core model kinematics rl episode",
    "install": "core model",
    "session": "core model kinematics collision path planning trajectory control sim render execution program view rl perception teleop episode",
}

# Where MuJoCo's own headers may be included; tests may, everywhere: MuJoCo is their oracle.
MUJOCO = [
    "mjarm/model/*.cpp", "mjarm/model/*_internal.hpp",
    "mjarm/collision/exact*.cpp", "mjarm/collision/exact*_internal.hpp",
    "mjarm/collision/contact_rules.cpp",
    "mjarm/collision/cover*.cpp", "mjarm/collision/cover*_internal.hpp",
    "mjarm/sim/*.cpp", "mjarm/sim/*_internal.hpp", "mjarm/sim/raw.hpp",
    "mjarm/render/*.cpp", "mjarm/render/*_internal.hpp",
    "mjarm/view/*.cpp", "mjarm/view/*_internal.hpp",
    "*_test.cpp", "*_test.hpp", "*_bench.cpp",
    "examples/learn/03_*.cpp",  # it is about MuJoCo's own model and data
]

# Where the operating system may be called directly.
SYSTEM = ["mjarm/core/os*.cpp", "*_test.cpp", "tests/*"]
SYSTEM_HEADERS = r"(unistd|dlfcn|fcntl|poll|signal|pthread|windows|termios|pwd|sys/.*|netinet/.*|arpa/.*)\.h"

# What a public header may include besides mjarm, Eigen and the standard library.
PUBLIC_THIRD_PARTY = {"tl/expected.hpp": "mjarm/core/result.hpp"}

# Not installed: for the kernels of every room, so no public header may include them.
KERNEL_HEADERS = "mjarm/core/simd/"

MOST_LINES = 500
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def matches(path, patterns):
    return any(fnmatch.fnmatch(path, pattern) for pattern in patterns)


def room_of(path):
    parts = path.split("/")
    return parts[1] if parts[0] == "mjarm" and len(parts) > 2 else None


def is_test(path):
    return bool(re.search(r"_(test|bench)\.(hpp|cpp)$", path)) or path.startswith("tests/")


def is_public_header(path):
    if not path.startswith("mjarm/") or path.startswith(KERNEL_HEADERS):
        return False
    return path.endswith(".hpp") and not re.search(r"_(internal|test)\.hpp$", path)


def room_fault(path, header):
    """Why the file may not include that header of mjarm, or None."""
    here, there = room_of(path), room_of(header)
    if there not in ALLOWED:
        return f"includes {header}, but there is no room {there}"
    if here and there != here and there not in ALLOWED[here].split():
        return f"includes {header}, but room {here} may include only: {ALLOWED[here] or 'nothing'}"
    if header.endswith("_internal.hpp") and here != there:
        return f"includes {header}, which is for room {there} alone"
    if header.startswith(KERNEL_HEADERS) and is_public_header(path):
        return f"includes {header}, which is not installed; kernels alone may"
    if is_test(header) and not is_test(path):
        return f"includes {header}, which is for tests"
    return None


def foreign_fault(path, header):
    """Why the file may not include that header from outside mjarm, or None."""
    if header.startswith("mujoco/") and not matches(path, MUJOCO):
        return f"includes {header}; MuJoCo's headers are for: {' '.join(MUJOCO)}"
    if re.match(r"(gtest|gmock|benchmark)/", header) and not is_test(path):
        return f"includes {header}, which is for tests"
    if re.fullmatch(SYSTEM_HEADERS, header) and not matches(path, SYSTEM):
        return f"includes {header}; calls of the operating system stand in {SYSTEM[0]}"
    if is_public_header(path) and not header.startswith(("Eigen/", "mujoco/")):
        if ("/" in header or header.endswith((".h", ".hpp"))) and PUBLIC_THIRD_PARTY.get(header) != path:
            return f"includes {header}; a public header shows the standard library and Eigen only"
    return None


def faults_of(path, text):
    """All faults of one file, `path` relative to the root of the project."""
    lines = text.splitlines()
    if len(lines) > MOST_LINES:
        yield f"{path}: {len(lines)} lines; more than {MOST_LINES} are too many for one idea"
    if room_of(path) is not None and room_of(path) not in ALLOWED:
        yield f"{path}: room {room_of(path)} is not in the order of tools/check_layers.py"
        return
    for number, line in enumerate(lines, 1):
        found = INCLUDE.match(line)
        if not found:
            continue
        header = found.group(2)
        if header.startswith("mjarm/"):
            fault = None if header.endswith(".inc") else room_fault(path, header)
        elif header == "all_messages.inc":  # made by CMake, for the tests of the catalogue
            fault = None if is_test(path) else f"includes {header}, which is for tests"
        elif header.startswith(("tests/", "bench/peers/")):
            fault = None if is_test(path) else f"includes {header}, which is for tests"
        elif found.group(1) == '"' and room_of(path):
            fault = f'includes "{header}"; write the path from the root: "mjarm/ROOM/FILE"'
        else:
            fault = foreign_fault(path, header)
        if fault:
            yield f"{path}:{number}: {fault}"


def check(root):
    faults = []
    for folder in ("mjarm", "apps", "examples", "tests", "tools"):
        for file in sorted((root / folder).rglob("*")):
            if file.suffix in (".hpp", ".cpp", ".py", ".sh"):
                path = file.relative_to(root).as_posix()
                faults.extend(faults_of(path, file.read_text(encoding="utf-8")))
    return faults


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
    if not (root / "mjarm").is_dir():
        sys.exit(f"{root}: no folder mjarm here")
    faults = check(root)
    print("\n".join(faults) if faults else "layers: no faults")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
