"""What the mutation test would say of a program with faults."""
import json
import pathlib
import random
import tempfile
import unittest

import arms
import mutate
import parsers
from run import Bounds, Run, faults_of, run


def told(script, files=()):
    """Faults of a program that is this shell script."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for file in files:
            (folder / file).write_text("")
        return list(faults_of(run("/bin/sh", ["-c", script], folder, Bounds(seconds=1)), ["in", "out"]))


class Ends(unittest.TestCase):
    def test_all_that_is_fine(self):
        for script in ("echo '{}'", "echo why >&2; exit 1", "echo in:1:2 >&2; exit 2", "echo 中 >&2; echo x > out; exit 2"):
            self.assertEqual(told(script, ["in"]), [], script)

    def test_each_fault(self):
        for script, fault in (("exit 3", "ended with 3"), ("kill -11 $$", "ended with -11"), ("while :; do :; done", "never ended"),
                              ("echo a >&2", "with a message"), ("exit 1", "0 lines"), ("echo a >&2; echo b >&2; exit 2", "2 lines"),
                              ("printf '\\033[31m\\n'", "0x1b"), ("printf '\\302\\233\\n' >&2; exit 2", "0x9b"),
                              ("printf '\\377'", "no UTF-8"), ("echo std::bad_alloc >&2; exit 1", "out of memory"),
                              ("echo > stray", "stray")):
            self.assertTrue(any(fault in said for said in told(script)), (script, told(script)))

    def test_memory_is_bounded(self):
        grow = "import sys; a = bytearray(3 << 30)"
        with tempfile.TemporaryDirectory() as name:
            result = run("/usr/bin/env", ["python3", "-c", grow], pathlib.Path(name), Bounds())
        self.assertEqual(result.code, 1)
        self.assertIn(b"MemoryError", result.err)


class Answers(unittest.TestCase):
    def faults(self, name, given, answer, code=0):
        parser = next(parser for parser in parsers.all_parsers() if parser.name == name)
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            if parser.made:
                (folder / parser.made[0]).write_text(answer)
            return parser.check(given, Run(code, answer.encode(), b"", folder))

    def test_poses(self):
        q = [0.1, -1.2, 1.3, -0.4, 0.5, 0.6]
        p = [arms.ur5e(q)[i][3] for i in range(3)]
        request = json.dumps({"pos": p, "quat": [0, 0, 0, 1]}).encode()
        self.assertTrue(self.faults("ik", request, json.dumps({"ok": True, "q": q})), "another rotation")
        self.assertTrue(self.faults("ik", request, ""), "no answer")
        self.assertFalse(self.faults("ik", request, json.dumps({"ok": False})))
        self.assertTrue(self.faults("fk", json.dumps({"q": q}).encode(), json.dumps({"pos": [0, 0, 0], "quat": [1, 0, 0, 0]})))

    def test_a_key_that_stands_twice_must_not_pass(self):
        self.assertTrue(self.faults("verify", b'{"p": [[5, 5]], ' + parsers.PATHS[1:], ""))
        self.assertFalse(self.faults("verify", parsers.PATHS, ""))

    def test_paths(self):
        through = json.dumps({"p": {"ok": True, "path": [[-0.8, 0], [0.8, 0]]}})
        self.assertIn("hits ball", self.faults("plan", parsers.PROBLEMS, through)[0])
        short = json.dumps({"p": {"ok": True, "path": [[-0.8, 0], [-0.8, 0.1]]}})
        self.assertIn("ends at", self.faults("plan", parsers.PROBLEMS, short)[0])

    def test_limits_of_motions(self):
        given = parsers.all_parsers()[3].seeds[0]
        samples = [[0, [0, 1], [0, 0], [0, 0]], [1, [1, -1], [1.1, 0], [0, 0]]]
        self.assertIn("beyond", self.faults("time", given, json.dumps({"c": {"ok": True, "samples": samples}}))[0])


class Mutations(unittest.TestCase):
    def test_same_seed_same_input_and_most_are_changes(self):
        for parser in parsers.all_parsers():
            inputs = [[parser.input(random.Random(f"7/{i}")) for i in range(8)] for _ in range(2)]
            self.assertEqual(*inputs)
            self.assertGreater(len(set(inputs[0])), 4, parser.name)

    def test_every_kind_of_change_comes(self):
        text, rng = b'{"pos": [0.1, 2], "quat": [1, 0]}\n<body>', random.Random(1)
        for usual, big in mutate.KINDS.values():
            for change in usual + big:
                self.assertTrue(any(change(text, rng) != text for _ in range(200)), change)


if __name__ == "__main__":
    unittest.main()
