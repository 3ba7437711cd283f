"""Runs what pages say: their blocks of sh and python, in order, and compares what they print with the blocks of text after them.

Usage: check_pages.py [--program MJARM] [--python PYTHON] [--root FOLDER] [--seconds S] [--tables] PAGE...

Each page has a folder of its own, empty for those of docs/learn; else with the folders of the project in it. Commands of sh share one shell, blocks
of python one process. `./dev ARGS` is `mjarm ARGS` here. A block of text that follows at once quotes what was printed: its lines in their order, `...`
for anything left out, numbers within 1 % or one unit of their last digit. A command may end with another exit code than 0 where a line of what it printed is
quoted, or where it says so: `# exit code 1` (in a row of a table, `<!-- exit code 1 -->`). Before a block, `<!-- not run: REASON -->` leaves it out and
`<!-- up to 300 s -->`, in a row of a table too, gives it more time.
--tables: the commands in the cells of tables as well. Both languages of a page have to run the same. The last line counts.
"""

import argparse
import ast
import dataclasses
import difflib
import json
import math
import os
import pathlib
import re
import secrets
import selectors
import shutil
import signal
import subprocess
import sys
import tempfile
import time

DEV_OWN = set("test long wheel page build format tidy asan tsan coverage arms fuzz peers docs windows help --no-install".split())
CHINESE = re.compile(r"[\u3000-\u303f\u4e00-\u9fff\uff00-\uffef]")
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
DRIVER = """
import builtins, json, os, sys, traceback
requests = os.fdopen(os.dup(0)); os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
os.dup2(1, 2); sys.path.insert(0, ""); space = {"__name__": "__main__"}
for line in requests:
    mark, name, source = json.loads(line)
    code = 0
    try:
        exec(compile(source, name, "exec"), space)
    except SystemExit as end:
        code = end.code if isinstance(end.code, int) else 0 if end.code is None else print(end.code) or 1
    except BaseException:
        code = 1
        traceback.print_exc()
    sys.stdout.flush(); sys.stderr.flush()
    os.write(1, f"\\n{mark} {code}\\n".encode())
"""


@dataclasses.dataclass
class Block:
    kind: str                # sh, python, text, or that of a file
    line: int                # of its first line, from 1
    lines: list[str]
    follows: bool = False    # nothing but blank lines since the block before
    skip: str = ""           # why it is not run
    seconds: float = 0       # its own limit, or 0

    @property
    def file(self):
        """The file that the reader saves it as, by its first line: `# own.yaml`, `<!-- own.xml -->`."""
        named = re.fullmatch(r"(?:#|//|<!--)\s*([\w-]+\.\w+)\s*(?:-->)?\s*", self.lines[0]) if self.lines else None
        return named.group(1) if named else ""


@dataclasses.dataclass
class Command:
    line: int
    text: str
    skip: str = ""
    seconds: float = 0       # its own limit, or 0
    printed: list[str] = dataclasses.field(default_factory=list)
    code: int = 0
    quoted: bool = False


def blocks_of(text):
    """The fenced blocks of a page that are run or compared."""
    blocks, end, block, note, follows = [], None, None, "", False
    for number, line in enumerate(text.splitlines(), 1):
        fence = re.match(r" {0,3}(`{3,})\s*(\w*)", line)
        if end is None and fence:
            end, kind = fence.group(1), fence.group(2)
            block = Block(kind, number + 1, [], follows)
            skip = re.fullmatch(r"<!-- not run: (.+) -->", note)
            more = re.fullmatch(r"<!-- up to (\d+) s -->", note)
            block.skip = skip.group(1) if skip else ""
            block.seconds = float(more.group(1)) if more else 0
        elif end is not None and line.strip() == end:
            if block.kind in ("sh", "python", "text") or block.file:
                blocks.append(block)
            end, note, follows = None, "", block.kind in ("sh", "python")
        elif end is not None:
            block.lines.append(line)
        elif line.strip():
            note, follows = line.strip(), False
    return blocks


def is_whole(command):
    if command.endswith("\\"):
        return False
    check = subprocess.run(["bash", "-n"], input=command + "\n", text=True, capture_output=True)
    return check.returncode == 0 and not check.stderr


def commands_of(block):
    """The commands of a block of sh; one may take several lines."""
    commands, begun = [], None
    for number, line in enumerate(block.lines, block.line):
        if begun is None and (not line.strip() or line.lstrip().startswith("#")):
            continue
        begun = Command(begun.line, f"{begun.text}\n{line}") if begun else Command(number, line)
        if is_whole(begun.text):
            commands.append(begun)
            begun = None
    if begun:
        commands.append(begun)
    for command in commands:
        command.skip = block.skip or reason_to_skip(command.text)
    return commands


def table_commands(text):
    """The commands in the cells of tables, each once."""
    found = {}
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("|"):
            for code in re.findall(r"`((?:\./dev|mjarm) [^`]+)`", line):
                said = re.search(r"<!-- (exit code \d+) -->", line)
                more = re.search(r"<!-- up to (\d+) s -->", line)
                found.setdefault(code, Command(number, f"{code}  # {said.group(1)}" if said else code, reason_to_skip(code) or reason_in_table(code),
                                               float(more.group(1)) if more else 0))
    return list(found.values())


def reason_in_table(command):
    """Words in capitals and files called my_... stand for something of the reader's own."""
    own = re.search(r"(?:^|\s)([A-Z_]{3,}|\[.*|\S*[\u4e00-\u9fff]\S*|my_\S+|\.\.\.)(?:\s|$)", command)
    return f"\"{own.group(1)}\" stands for something of the reader's own" if own and "--text" not in command else ""


def reason_to_skip(text):
    """Why a command is not run here, or nothing."""
    for part in re.split(r"&&|\|\||;|\||\n", text):
        words = part.split("#")[0].split()
        while words and re.fullmatch(r"\w+=\S*", words[0]):
            words.pop(0)
        if not words:
            continue
        program, rest = words[0], words[1:]
        first = rest[0] if rest else ""
        if program == "./dev" and (first in DEV_OWN or rest in ([], ["bench"], ["check"])):
            return "a command of ./dev itself"
        if program in ("./dev", "mjarm"):
            if first == "bench":
                return "measures the machine"
            if first == "models" and "install" in rest:
                return "fetches from the network"
            if (first in ("view", "teleop") or "--view" in rest) and "--seconds" not in rest:
                return "opens a window"
            if (first == "serve" or "--serve" in rest) and "--seconds" not in rest:
                return "runs until it is closed"
        if program in ("sudo", "apt", "apt-get", "git", "pip", "pip3", "pipx", "npm", "ssh", "wsl", "winget", "deactivate", "docker") or (
                program.startswith("python") and rest[:2] in (["-m", "venv"], ["-m", "pip"])) or (
                program in (".", "source") and "activate" in first) or "pip" in program.split("/")[-1:]:
            return "changes the machine"
    return ""


class Session:
    """A process that takes one piece of work after the other and tells what each printed."""

    def __init__(self, arguments, wrap, folder, environment):
        self.start = lambda: subprocess.Popen(arguments, cwd=folder, env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                              stderr=subprocess.STDOUT, start_new_session=True)
        self.wrap, self.process = wrap, None

    def run(self, name, source, seconds):
        """(lines printed, exit code); the code is None when it took too long, and the session is over when it ended."""
        if self.process is None:
            self.process = self.start()
        mark = f"mark-{secrets.token_hex(8)}"
        self.process.stdin.write(self.wrap(mark, name, source).encode())
        self.process.stdin.flush()
        out, end, code = b"", time.monotonic() + seconds, None
        done = re.compile(rb"\n" + mark.encode() + rb" (-?\d+)\n")
        with selectors.DefaultSelector() as selector:
            selector.register(self.process.stdout, selectors.EVENT_READ)
            while not (found := done.search(out[-4096:])) and time.monotonic() < end:
                if selector.select(max(0, end - time.monotonic())):
                    part = os.read(self.process.stdout.fileno(), 65536)
                    if not part:
                        code = self.process.wait()
                        break
                    out += part
        if found:
            code, out = int(found.group(1)), done.sub(b"", out)
        else:
            self.close()
        return out.decode("utf-8", "replace").replace("\r", "\n").splitlines(), code

    def close(self):
        if self.process:
            try:
                os.killpg(self.process.pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
            self.process.wait()
            self.process.stdin.close()
            self.process.stdout.close()
        self.process = None


def quote(text):
    return "'" + text.replace("'", "'\\''") + "'"


def wrap_sh(mark, _, source):
    return f"eval {quote(source)} </dev/null; printf '\\n%s %d\\n' {mark} $?\n"


def wrap_python(mark, name, source):
    return json.dumps([mark, name, source]) + "\n"


def same_number(expected, printed):
    digits, _, exponent = expected.lower().partition("e")
    unit = 10.0 ** (int(exponent or 0) - len(digits.partition(".")[2]))
    a, b = float(expected), float(printed)
    return a == b or (math.isfinite(a) and abs(a - b) <= max(0.01 * abs(a), unit * 1.0001, 1e-9))


def same_line(expected, printed):
    """True where one stands for the other: equal words, close numbers, any number of blanks."""
    if "..." in expected.strip(" .") or expected.strip().endswith("...") or expected.strip().startswith("..."):
        parts = [NUMBER.sub("\0", part) for part in expected.strip().split("...")]
        blanks = [re.sub(r"\s+", r"\\s+", re.escape(part).replace("\\ ", " ").replace("\0", f"({NUMBER.pattern})")) for part in parts]
        found = re.fullmatch(r"\s*" + ".*".join(blanks) + r"\s*", printed.strip())
        if found:
            return all(map(same_number, NUMBER.findall("".join(f"{part}\0" for part in expected.split("..."))), found.groups()))
        return " ".join(expected.split()) == " ".join(printed.split())
    a, b = (" ".join(NUMBER.sub("\0", line).split()) for line in (expected, printed))
    return a == b and all(map(same_number, NUMBER.findall(expected), NUMBER.findall(printed)))


def first_missing(expected, printed):
    """(index of the first line that was not printed in this order, or None; indices of the printed lines that were met)"""
    at, met = 0, []
    for i, line in enumerate(expected):
        if not line.strip() or line.strip() == "...":
            continue
        while at < len(printed) and not same_line(line, printed[at]):
            at += 1
        if at == len(printed):
            return i, met
        met.append(at)
        at += 1
    return None, met


def nearest(line, printed):
    found = difflib.get_close_matches(line.strip(), [one.strip() for one in printed if one.strip()], n=1, cutoff=0)
    return found[0] if found else "(nothing was printed)"


def same_python(one, other):
    """True where two programs differ in comments, in their language ("en" and "zh") and in words with Chinese in the other one alone."""
    try:
        trees = [ast.parse("\n".join(line for line in block.lines if "set_language(" not in line)) for block in (one, other)]
    except SyntaxError:
        return one.lines == other.lines
    for tree in trees:
        for node in ast.walk(tree):
            if isinstance(node, ast.JoinedStr):
                node.values = sorted((part for part in node.values if not isinstance(part, ast.Constant)), key=ast.dump)
    pairs = list(zip(*([n for n in ast.walk(tree) if isinstance(n, ast.Constant) and isinstance(n.value, str)] for tree in trees)))
    for a, b in pairs:
        if CHINESE.search(b.value) or (a.value, b.value) == ("en", "zh"):
            a.value = b.value = ""
    return ast.dump(trees[0]) == ast.dump(trees[1])


def same_sh(one, other):
    def words(line):
        return re.sub(r"\"[^\"]*\"|'[^']*'", "''", re.sub(r"\s+#.*$|^#.*$", "", line)).split()

    lines = [[re.sub(r"\s+#.*$|^#.*$|\s--lang\s\S+", "", line) for line in block.lines] for block in (one, other)]
    a, b = ([line for line in block if line.strip()] for block in lines)
    if len(a) != len(b):
        return False
    for x, y in zip(a, b):
        if CHINESE.search(y):
            x, y = words(x), words(y)
            if len(x) != len(y) or any(v != w and not CHINESE.search(w) for v, w in zip(x, y)):
                return False
        elif x.split() != y.split():
            return False
    return True


def twin_fault(page, other):
    """(line, what) where the page in the other language does not run the same, or None."""
    a, b = ([block for block in blocks_of(one.read_text(encoding="utf-8")) if block.kind != "text"] for one in (page, other))
    for one, two in zip(a, b):
        if (one.kind, one.file) != (two.kind, two.file) or not (same_python if one.kind == "python" else same_sh)(one, two):
            return two.line, f"this block is not that of line {one.line} in {page.name}"
    if len(a) != len(b):
        return 1, f"{len(b)} blocks are run here, {len(a)} in {page.name}"
    return None


class Checker:
    def __init__(self, options):
        self.options = options
        self.root = pathlib.Path(options.root).resolve()
        self.passed = self.failed = self.skipped = 0

    def good(self):
        self.passed += 1

    def bad(self, page, line, *what):
        self.failed += 1
        print(f"FAILED: {self.name(page)}:{line}: " + "\n    ".join(what), flush=True)

    def left_out(self, page, line, text, why):
        self.skipped += 1
        print(f"SKIPPED: {self.name(page)}:{line}: {text.splitlines()[0]}: {why}", flush=True)

    def name(self, page):
        return page.relative_to(self.root).as_posix() if page.is_relative_to(self.root) else str(page)

    def environment(self, page, work):
        """What a reader without a display has, in the language of the page."""
        tools = work / "bin"
        tools.mkdir()
        (tools / "mjarm").write_text(f"#!/bin/sh\nexec {quote(str(self.options.program))} \"$@\"\n")
        for name in ("python", "python3"):
            (tools / name).write_text(f"#!/bin/sh\nexec {quote(str(self.options.python))} \"$@\"\n")
        for tool in tools.iterdir():
            tool.chmod(0o755)
        values = {name: value for name, value in os.environ.items()
                  if name not in ("DISPLAY", "WAYLAND_DISPLAY", "LC_ALL", "LC_MESSAGES", "LANGUAGE", "PYTHONPATH")}
        return values | {"PATH": f"{tools}:{os.environ['PATH']}", "LANG": "zh_CN.UTF-8" if ".zh-CN." in page.name else "C.UTF-8",
                         "PYTHONUTF8": "1", "PYTHONDONTWRITEBYTECODE": "1", "MPLBACKEND": "Agg", "XDG_CACHE_HOME": str(work / "cache")}

    def folder(self, page, work):
        """Where its commands run."""
        folder = work / "run"
        folder.mkdir()
        (folder / "dev").write_text("#!/bin/sh\nMJARM_CALLED_AS=$0 exec mjarm \"$@\"\n")
        (folder / "dev").chmod(0o755)
        if "learn" not in page.parts:
            for entry in self.root.iterdir():
                if not re.match(r"\.|build|dist$|out$|mjarm-out$|dev$", entry.name):
                    (folder / entry.name).symlink_to(entry)
        return folder

    def check(self, page):
        page = page.resolve()
        text = page.read_text(encoding="utf-8")
        other = page.with_name(page.name.replace(".md", ".zh-CN.md"))
        if ".zh-CN." not in page.name and other.exists():
            fault = twin_fault(page, other)
            self.bad(other, *fault) if fault else self.good()
        with tempfile.TemporaryDirectory(prefix="page.") as work:
            work = pathlib.Path(work)
            environment, folder = self.environment(page, work), self.folder(page, work)
            shell = Session(["bash", "--noprofile", "--norc"], wrap_sh, folder, environment)
            python = Session([str(self.options.python), "-u", "-c", DRIVER], wrap_python, folder, environment)
            try:
                self.run_blocks(page, blocks_of(text), folder, shell, python)
                if self.options.tables:
                    self.run_tables(page, text, shell)
            finally:
                shell.close()
                python.close()

    def run_blocks(self, page, blocks, folder, shell, python):
        for block, after in zip(blocks, [*blocks[1:], None]):
            if block.file:
                (folder / block.file).write_text("\n".join(block.lines) + "\n", encoding="utf-8")
            if block.kind not in ("sh", "python"):
                continue
            quoted = after if after and after.kind == "text" and after.follows else None
            if block.kind == "sh":
                commands = commands_of(block)
            else:
                commands = [Command(block.line, "\n".join(block.lines), block.skip)]
            for command in commands:
                if not command.skip:
                    seconds = block.seconds or self.options.seconds
                    source = "\n" * (command.line - 1) + command.text if block.kind == "python" else command.text
                    command.printed, command.code = (shell if block.kind == "sh" else python).run(page.name, source, seconds)
            ran = [command for command in commands if not command.skip]
            if quoted and ran:
                self.compare(page, quoted, ran)
            elif quoted:
                self.left_out(page, quoted.line, "text", "what prints it was not run")
            for command in commands:
                self.judge(page, command, block.seconds or self.options.seconds)

    def compare(self, page, block, commands):
        printed = [(command, line) for command in commands for line in command.printed]
        missing, met = first_missing(block.lines, [line for _, line in printed])
        for i in met:
            printed[i][0].quoted = True
        if missing is None:
            self.good()
            return
        line = block.lines[missing]
        rest = [line for _, line in printed[(met[-1] + 1 if met else 0):]]
        self.bad(page, block.line + missing, "not printed", f"expected: {line.strip()}", f"nearest:  {nearest(line, rest or [l for _, l in printed])}")

    def judge(self, page, command, seconds):
        if command.skip:
            self.left_out(page, command.line, command.text, command.skip)
            return
        said = re.search(r"#.*?(?:exit code|退出码)\s*(\d+)", command.text)
        if command.code is None:
            self.bad(page, command.line, f"took longer than {seconds:g} s", command.text, *command.printed[-3:])
        elif command.code == int(said.group(1)) if said else command.code == 0 or (command.quoted and command.code in (1, 2)):
            self.good()
        else:
            last = [line for line in command.printed if line.strip()][-5:]
            self.bad(page, command.line, f"exit code {command.code}", *command.text.splitlines()[:1], *last)

    def run_tables(self, page, text, shell):
        twin = page.with_name(page.name.replace(".zh-CN.md", ".md"))
        known = {one.text for one in table_commands(twin.read_text(encoding="utf-8"))} if twin != page and twin.exists() else set()
        for command in table_commands(text):
            if not command.skip and command.text in known:
                command.skip = f"as in {twin.name}"
            seconds = command.seconds or self.options.seconds
            if not command.skip:
                command.printed, command.code = shell.run(page.name, command.text, seconds)
            self.judge(page, command, seconds)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default="mjarm", help="what `mjarm` is in the pages")
    parser.add_argument("--python", default=sys.executable, help="runs the blocks of python; has mjarm installed")
    parser.add_argument("--root", default=pathlib.Path(__file__).resolve().parent.parent)
    parser.add_argument("--seconds", type=float, default=120, help="the most one command may take")
    parser.add_argument("--tables", action="store_true")
    parser.add_argument("pages", nargs="+", type=pathlib.Path)
    options = parser.parse_args()
    program = shutil.which(options.program)
    if not program:  # a name that nothing has would call the wrapper of that name again and again
        parser.error(f"--program: \"{options.program}\" is no program")
    options.program = pathlib.Path(program).resolve()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # so that the shells of a page end with it
    checker = Checker(options)
    for page in checker.options.pages:
        checker.check(page)
    print(f"{checker.passed} passed, {checker.failed} failed, {checker.skipped} skipped")
    sys.exit(1 if checker.failed else 0)


if __name__ == "__main__":
    main()
