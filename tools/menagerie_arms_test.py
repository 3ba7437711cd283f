"""Tests of menagerie_arms.py, with a program that says what mjarm would."""

import pathlib
import stat
import tempfile
import unittest

import menagerie_arms

# Two arms and a neck; the first arm refuses hard poses, the square of the second fails, and no picture is drawn.
PROGRAM = """#!/usr/bin/env python3
import json, sys
words = sys.argv[3:]
tip = words[words.index("--tip") + 1] if "--tip" in words else ""
if words[:2] == ["model", "info"]:
    count = {"left": 6, "left_camera": 6, "right": 6, "head": 2}.get(tip)
    arm = count and {"home": [0.5] * count,
                     "joints": [{"name": tip[:4] + str(k), "position": [0, 2]} for k in range(count)]}
    print(json.dumps({"arm": arm or None, "no_arm": "two.xml: there are 3 arms in it; choose one by its tip: "
                      "left, left_camera, right, head"}))
elif words[0] == "fk":
    print(json.dumps({"pos": [0, 0, 1], "quat": [1, 0, 0, 0]}))
elif words[:3] == ["bench", "ik", "--hard"] and tip == "left":
    print("two: 3 poses that it reaches are refused or answered wrongly", file=sys.stderr)
    sys.exit(1)
elif words[:2] == ["demo", "square"] and tip == "right":
    print("start", file=sys.stderr)
    print("square: path_error: error 97 mm", file=sys.stderr)
    print("files in there", file=sys.stderr)
    sys.exit(1)
elif words[0] == "plan" and words[words.index("--goal") + 1] != ",".join(["0.6"] * 6):
    sys.exit(3)
"""


def fetch(name):
    if name == "far":
        raise menagerie_arms.Absent("it cannot be reached")
    if name == "odd":
        raise menagerie_arms.Broken("not what was pinned")
    return pathlib.Path("two.xml")


class TryAll(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        program = pathlib.Path(folder.name) / "mjarm"
        program.write_text(PROGRAM, encoding="utf-8")
        program.chmod(program.stat().st_mode | stat.S_IXUSR)
        cls.results, cls.absent = menagerie_arms.try_all(str(program), ["far", "odd", "two"], fetch, 2)

    def test_each_arm_of_a_robot_goes_through_every_command(self):
        tried = [(one.tip, one.what) for one in self.results if one.robot == "two"]
        self.assertEqual(tried, [(tip, what) for tip in ("left", "right") for what in menagerie_arms.STEPS])

    def test_what_fails_is_told_with_its_last_words(self):
        failed = {(one.tip, one.what): one.reason for one in self.results if one.robot == "two" and one.reason}
        self.assertEqual(failed, {("right", "demo square"): "square: path_error: error 97 mm",
                                  ("left", "hard poses"): "two: 3 poses that it reaches are refused or answered wrongly",
                                  ("left", "render"): "there is no picture",
                                  ("right", "render"): "there is no picture"})
        rows = menagerie_arms.table(self.results)
        self.assertIn("two (right)  demo square  square: path_error: error 97 mm", rows)
        self.assertIn("two (left)   ik           ok", rows)

    def test_what_cannot_be_fetched_is_no_fault_but_what_is_wrong_is(self):
        self.assertEqual(dict(self.absent), {"it cannot be reached": ["far"]})
        odd = [one.reason for one in self.results if one.robot == "odd"]
        self.assertEqual(odd, ["not what was pinned"] * len(menagerie_arms.STEPS))


if __name__ == "__main__":
    unittest.main()
