"""The numbered examples run, each a page long."""

import pathlib
import subprocess
import sys

import pytest

FOLDER = pathlib.Path(__file__).parents[1] / "examples"
EXAMPLES = sorted(FOLDER.glob("[0-9][0-9]_*.py"))
LESSONS = sorted(FOLDER.glob("learn/[0-9][0-9]_*.py"))


def test_they_mirror_those_in_cpp():
    cpp = pathlib.Path(__file__).parents[2] / "examples"
    assert [file.stem for file in EXAMPLES][:15] == sorted(file.stem for file in cpp.glob("[0-9][0-9]_*.cpp"))
    assert [file.stem for file in LESSONS] == sorted(file.stem for file in cpp.glob("learn/[0-9][0-9]_*.cpp"))


@pytest.mark.parametrize("file", [*EXAMPLES, *LESSONS], ids=lambda file: file.stem)
def test_it_runs(file, tmp_path):
    assert len(file.read_text(encoding="utf-8").splitlines()) <= 40
    done = subprocess.run([sys.executable, str(file)], capture_output=True, text=True, timeout=300, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout and not done.stderr
