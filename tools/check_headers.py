"""Checks that every public header of mjarm compiles alone, with the flags of somebody who uses the library.

Usage: check_headers.py BUILD. BUILD holds compile_commands.json, and what is known of headers that have not
changed since. Prints what the compiler says of each that does not; exit code 1 when there is one.
"""

import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys

import check_layers

INCLUDE = re.compile(r'^\s*#\s*include\s*"(mjarm/[^"]+)"', re.MULTILINE)

# Headers that many others include, the largest first: compiled once for all of these. A header is helped by some only
# where it includes them all, so nothing is there that would not be there without.
SHARED = [tuple(f"mjarm/{header}.hpp" for header in group.split()) for group in (
    "sim/sim kinematics/chain", "model/model kinematics/chain", "sim/sim", "kinematics/chain",
    "model/model core/pose", "model/model", "model/arm core/result", "model/arm", "core/pose core/result",
    "core/joint_vec", "core/pose", "core/result")]

# Memory is collected rarely: that took a fifth of the time.
ROOMY = ["--param", "ggc-min-heapsize=1000000", "--param", "ggc-min-expand=400"]

# Stands behind each header and ends the compiler there: half its time went into the bodies of templates, which every
# build compiles anyway.
END = 'static_assert(false, "the header stands alone");\n'


def closure(root, header, seen=None):
    """All headers of mjarm that one includes, itself first."""
    seen = {} if seen is None else seen
    if header not in seen and (root / header).is_file():
        seen[header] = (root / header).read_text(encoding="utf-8")
        for other in INCLUDE.findall(seen[header]):
            closure(root, other, seen)
    return seen


def user_flags(build):
    """Compiler and include folders, without what holds for our own targets alone."""
    entries = json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
    commands = [shlex.split(entry["command"]) for entry in entries]
    compiler = next(word for word in commands[0] if re.search(r"^[^=]*\+\+[^/=]*$", word))
    folders = sorted({words[i + 1] for words in commands for i, word in enumerate(words) if word == "-isystem"})
    return [compiler, "-std=c++20", "-Wall", "-Wextra", "-Werror", *ROOMY, *(f"-isystem{folder}" for folder in folders)]


def precompile(flags, work, headers):
    """A file to be included first, which stands for the headers precompiled; None where they do not compile."""
    prefix = work / "+".join(headers).replace("/", "_")
    prefix.write_text("".join(f'#include "{header}"\n' for header in headers), encoding="utf-8")
    done = subprocess.run([*flags, "-x", "c++-header", prefix, "-o", f"{prefix}.gch"], capture_output=True)
    return prefix if done.returncode == 0 else None


def compile_alone(flags, header, prefix):
    """What the compiler says of the header, nothing where all is well."""
    first = ["-Winvalid-pch", "-include", prefix] if prefix else []
    done = subprocess.run([*flags, *first, "-Wfatal-errors", "-fsyntax-only", "-x", "c++", "-"],
                          input=f'#include "{header}"\n{END}', capture_output=True, text=True)
    return "" if "the header stands alone" in done.stderr else f"{header} does not compile alone:\n{done.stderr}"


def check(root, build):
    """What the compiler says, one text for each header that does not compile alone."""
    flags = [*user_flags(build), f"-I{root}"]
    work = build / "headers_alone"
    work.mkdir(exist_ok=True)
    known_file = work / "known.json"
    known = json.loads(known_file.read_text()) if known_file.is_file() else {}
    paths = sorted(path.relative_to(root).as_posix() for path in (root / "mjarm").rglob("*.hpp"))
    closures = {path: closure(root, path) for path in paths if check_layers.is_public_header(path)}
    marks = {path: hashlib.sha256(repr((flags, sorted(texts.items()))).encode()).hexdigest()
             for path, texts in closures.items()}
    changed = [path for path in closures if known.get(path) != marks[path]]

    shared = {path: next((group for group in SHARED if set(group) <= closures[path].keys() - {path}), None) for path in changed}
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        wanted = sorted(set(shared.values()) - {None})
        prefixes = dict(zip(wanted, pool.map(lambda header: precompile(flags, work, header), wanted)))
        said = pool.map(lambda path: compile_alone(flags, path, prefixes.get(shared[path])), changed)
        faults = dict(zip(changed, said))
    known_file.write_text(json.dumps({path: mark for path, mark in marks.items() if not faults.get(path)}))
    return [fault for fault in faults.values() if fault]


def main():
    faults = check(pathlib.Path(__file__).resolve().parent.parent, pathlib.Path(sys.argv[1]).resolve())
    print("\n".join(faults), end="\n" if faults else "")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
