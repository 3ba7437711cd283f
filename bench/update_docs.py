"""Brings the tables of docs/benchmarks.md and of its Chinese page up to date.

Usage: update_docs.py [ik|path|plan|near|time|control|pick|python|rl] MJARM [ARGUMENTS of `mjarm bench SUITE`...], e.g.
update_docs.py ik build/release/bin/mjarm --data cases --peers .venv
update_docs.py plan build/release/bin/mjarm --data motionbenchmaker --peers .venv
update_docs.py near build/release/bin/mjarm --data FOLDER --peers .venv-near
update_docs.py rl build/release/bin/mjarm --peers .venv-rl
Without a suite all but plan, near and rl run with the same arguments, where --data SUITE=DIR names a folder for one suite.
"""

import pathlib
import shutil
import subprocess
import sys
import tempfile

SUITES = ("ik", "path", "time", "control", "pick", "python")
PICTURES = {"plan": "bench_plan", "near": "bench_plan", "rl": "curves"}  # drawn by suites that run by themselves only
SUITE_OF = {"plan": ("plan", "--set", "panda,ur5,anytime,scaling"), "near": ("plan", "--set", "near")}
DOCS = pathlib.Path(__file__).resolve().parent.parent / "docs"
PAGES = [DOCS / name for name in ("benchmarks.md", "benchmarks.zh-CN.md")]


def arguments_of(suite, arguments):
    """Leaves out the folders that are for other suites."""
    out = []
    for word in arguments:
        name, _, folder = word.partition("=")
        if name not in SUITES or not folder:
            out.append(word)
        elif name == suite:
            out.append(folder)
        else:
            out.pop()  # the --data before it
    return out


def update(suite, program, arguments):
    begin, end = f"<!-- {suite}: begin -->\n", f"<!-- {suite}: end -->\n"
    own = [] if suite in ("control", "pick") else arguments_of(suite, arguments)  # these take neither cases nor peers
    command = [program, "--lang", "en", "bench", *SUITE_OF.get(suite, (suite,)), *own]
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(done.returncode)
    for page in PAGES:
        before, rest = page.read_text(encoding="utf-8").split(begin)
        after = rest.split(end)[1]
        page.write_text(before + begin + "\n" + done.stdout.rstrip("\n") + "\n\n" + end + after, encoding="utf-8")


def update_with_picture(suite, program, arguments):
    """These suites take minutes, write a folder and draw a picture there."""
    with tempfile.TemporaryDirectory() as folder:
        update(suite, program, [*arguments, "--out", folder])
        drawn = pathlib.Path(folder) / f"{PICTURES[suite]}.png"
        shutil.copy(drawn, DOCS / "images" / f"bench_{suite}.png")


def main(words):
    if words and words[0] in PICTURES:
        return update_with_picture(words[0], words[1], words[2:])
    suites = SUITES
    if words and words[0] in SUITES:
        suites, words = words[:1], words[1:]
    for suite in suites:
        update(suite, words[0], words[1:])


if __name__ == "__main__":
    main(sys.argv[1:])
