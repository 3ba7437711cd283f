"""Brings the tables of docs/benchmarks.md up to date.

Usage: update_docs.py MJARM [ARGUMENTS of `mjarm bench ik`...], e.g.
update_docs.py build/release/bin/mjarm --data cases --peers .venv
"""

import pathlib
import subprocess
import sys

BEGIN, END = "<!-- ik: begin -->\n", "<!-- ik: end -->\n"


def main(program, arguments):
    page = pathlib.Path(__file__).resolve().parent.parent / "docs" / "benchmarks.md"
    done = subprocess.run([program, "--lang", "en", "bench", "ik", *arguments], stdout=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(done.returncode)
    before, rest = page.read_text(encoding="utf-8").split(BEGIN)
    after = rest.split(END)[1]
    page.write_text(before + BEGIN + "\n" + done.stdout.rstrip("\n") + "\n\n" + END + after, encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
