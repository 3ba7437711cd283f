"""Tests of how refusals.py judges, with programs that only pretend to be mjarm. Run: python3 tools/refusals_test.py"""

import pathlib
import signal
import sys
import tempfile
import unittest
import xml.etree.ElementTree

import refusals


class RefusalsTest(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def mjarm(self, text):
        """What runs as this Python program."""
        file = self.folder / "pretender"
        file.write_text(f"#!{sys.executable}\nimport json, signal, sys, time\n{text}\n", encoding="utf-8")
        file.chmod(0o755)
        return refusals.Mjarm(file, self.folder)

    def test_what_has_to_succeed(self):
        self.assertIn("processors", str(self.mjarm("print(sys.argv)").done("plan")))
        with self.assertRaisesRegex(refusals.Wrong, "plan: no path"):
            self.mjarm("sys.exit('no path')").done("plan")

    def test_what_has_to_be_refused_is_refused_with_its_reason_and_soon(self):
        says = "sys.exit('the start: a touches b')"
        self.mjarm(says).refused("start.*touches b", "plan")
        with self.assertRaisesRegex(refusals.Wrong, '"goal" is not said'):
            self.mjarm(says).refused("goal", "plan")
        with self.assertRaisesRegex(refusals.Wrong, "exit code 0, expected 1"):
            self.mjarm("print('a touches b', file=sys.stderr)").refused("touches", "plan")
        self.addCleanup(setattr, refusals, "CPU", refusals.CPU)
        refusals.CPU = 0
        with self.assertRaisesRegex(refusals.Wrong, "the reason took"):
            self.mjarm(says).refused("touches", "plan")

    def test_a_path_that_is_not_valid_is_no_path(self):
        verdict = "print('{\"valid\": %d}') if sys.argv[3] == 'verify' else None"
        self.mjarm(verdict % 1).planned("a.xml")
        with self.assertRaisesRegex(refusals.Wrong, "not valid"):
            self.mjarm(verdict % 0).planned("a.xml")

    def test_a_pose_that_is_missed_is_told(self):
        run = "print(json.dumps({'robots': [{'runs': [{'set': 'zero', 'right': %d, 'cases': 300}]}]}))"
        self.assertEqual(refusals.hard_poses(self.mjarm(run % 300), ["a", "b"]), "600 of 600 right")
        with self.assertRaisesRegex(refusals.Wrong, "299 of 300 right, not: a zero"):
            refusals.hard_poses(self.mjarm(run % 299), ["a"])
        with self.assertRaises(refusals.Wrong):
            refusals.hard_poses(self.mjarm(run % 300), ["a"], ("limit_1",))

    def test_a_search_that_stays_is_told(self):
        with self.assertRaisesRegex(refusals.Wrong, "had ended"):
            refusals.stopped(self.mjarm("pass"), signal.SIGTERM)
        late = "signal.signal(signal.SIGINT, lambda *_: (time.sleep(1.2), sys.exit('stopped')))\nsignal.pause()"
        with self.assertRaisesRegex(refusals.Wrong, "to the end"):
            refusals.stopped(self.mjarm(late), signal.SIGINT)

    def test_arms_are_whole(self):
        for rows in (refusals.WRIST, refusals.PARALLEL, refusals.STRAIGHT):
            model = xml.etree.ElementTree.fromstring(refusals.mjcf(rows, 1e-5, hand=refusals.HAND, ranges=["-1 1"] * len(rows), home="0 0"))
            self.assertEqual(len(model.findall(".//joint")), len(rows) + 2)
            self.assertEqual(len(model.findall("actuator/position")), len(rows) + 2)
            self.assertEqual(model.find("keyframe/key").get("qpos"), "0 0")

    def test_rows_are_counted(self):
        def raises(error):
            def measure(_):
                raise error
            return measure
        cases = [refusals.Case(1, "a", "refused", lambda _: "told"), refusals.Case(2, "b", "9 s", raises(refusals.Absent("no peer"))),
                 refusals.Case(3, "c", "9 s", raises(refusals.Wrong("8 s"))), refusals.Case(3, "d", "9 s", raises(KeyError("who")))]
        rows = [refusals.measured(case, None) for case in cases]
        self.assertEqual([row[-1] for row in rows][:3], ["ok", "SKIPPED", "WRONG: 8 s"])
        self.assertIn("'who'", rows[3][-1])
        self.assertEqual(refusals.counts(rows), "1 2 1")
        lines = refusals.table(rows)
        self.assertEqual(len({len(line) for line in lines}), 1)
        self.assertEqual([cell.strip() for cell in lines[2].split("|")[1:-1]], ["1", "a", "refused", "told", "ok"])

    def test_each_row_of_eleven_is_asked(self):
        self.assertEqual({case.row for case in refusals.CASES}, set(range(1, 12)))


if __name__ == "__main__":
    unittest.main()
