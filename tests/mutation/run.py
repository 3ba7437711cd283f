"""Runs the program on one input, in bounds, and looks at how it ended."""
import json
import os
import pathlib
import signal
import subprocess
from dataclasses import dataclass


@dataclass
class Bounds:
    """Of one run."""

    memory: float = 2  # [GiB] of addresses; 0: no bound, for sanitizers
    seconds: int = 30  # of computing time, which is the same on a busy machine


@dataclass
class Run:
    code: int  # -N: ended by signal N
    out: bytes
    err: bytes
    folder: pathlib.Path

    def made(self, name):
        """Content of a file that it wrote; none where it did not."""
        file = self.folder / name
        return file.read_bytes() if file.is_file() else None


def run(program, arguments, folder, bounds):
    limits = f"ulimit -c 0; ulimit -t {bounds.seconds}; " + (f"ulimit -v {int(bounds.memory * 2**20)}; " if bounds.memory else "")
    command = ["/bin/sh", "-c", limits + 'exec "$0" "$@"', program, *arguments]
    environment = {**os.environ, "LC_ALL": "C", "XDG_DATA_HOME": str(folder)}
    with subprocess.Popen(command, cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, start_new_session=True) as child:
        try:
            out, err = child.communicate(timeout=8 * bounds.seconds)
        except subprocess.TimeoutExpired:
            os.killpg(child.pid, signal.SIGKILL)
            out, err = child.communicate()
        return Run(child.returncode, out, err, folder)


def unsafe(printed):
    """What a terminal would obey or cannot show, of what the program printed."""
    try:
        text = printed.decode()
    except UnicodeDecodeError as error:
        return f"no UTF-8 at byte {error.start}"
    for char in text:
        if (ord(char) < 32 and char not in "\n\t") or 127 <= ord(char) < 160:
            return f"control character {ord(char):#x}"
    return None


def faults_of(result, expected):
    """What no input may do. expected: names of files that may lie in the folder."""
    if result.code in (-signal.SIGXCPU, -signal.SIGKILL):
        yield "never ended"
        return
    if result.code not in (0, 1, 2):
        yield f"ended with {result.code}"
    lines = result.err.splitlines()
    if result.code == 0 and lines:
        yield "exit code 0 with a message"
    if result.code in (1, 2) and len(lines) != 1:
        yield f"{len(lines)} lines on stderr"
    if b"bad_alloc" in result.err:
        yield "out of memory"
    for name, printed in (("stdout", result.out), ("stderr", result.err)):
        if (why := unsafe(printed)) is not None:
            yield f"{name}: {why}"
    stray = {path.name for path in result.folder.iterdir()} - set(expected)
    if stray:
        yield f"left behind: {sorted(stray)}"


class NotStrict(ValueError):
    pass


def strict_json(text):
    """A document of JSON as the standard has it: no key twice, no NaN. Raises ValueError."""

    def members(pairs):
        result = dict(pairs)
        if len(result) != len(pairs):
            raise NotStrict("a key stands twice")
        return result

    def constant(word):
        raise NotStrict(word)

    return json.loads(text, object_pairs_hook=members, parse_constant=constant)
