"""Tests of the summary of test results. Run: python3 tools/test_summary_test.py"""

import contextlib
import io
import pathlib
import tempfile
import unittest

import test_summary

RESULTS = """<?xml version="1.0"?>
<testsuite name="x" tests="5">
  <testcase name="core.A" status="run"/>
  <testcase name="core.B" status="fail"><failure message="Failed"/></testcase>
  <testcase name="core.C" status="notrun"><skipped message="SKIP_REGULAR_EXPRESSION_MATCHED"/>
    <system-out>mjarm/core/x_test.cpp:4: Skipped
set MJARM_TEST_DATA; needed for a.json
[  SKIPPED ] C</system-out></testcase>
  <testcase name="core.D" status="notrun"><skipped message="SKIP_REGULAR_EXPRESSION_MATCHED"/>
    <system-out>mjarm/core/x_test.cpp:9: Skipped
set MJARM_TEST_DATA</system-out></testcase>
  <testcase name="core.E" status="disabled"><skipped message="Disabled"/></testcase>
</testsuite>
"""

PYTEST = """<?xml version="1.0"?>
<testsuites><testsuite name="pytest" tests="4">
  <testcase classname="tests.a" name="passes" time="0.1"/>
  <testcase classname="tests.a" name="fails"><failure message="assert 1 == 2">...</failure></testcase>
  <testcase classname="tests.a" name="breaks"><error message="fixture">...</error></testcase>
  <testcase classname="tests.a" name="waits"><skipped type="pytest.skip" message="no display"/></testcase>
</testsuite></testsuites>
"""


class SummaryTest(unittest.TestCase):
    def lines_of(self, results):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "results.xml"
            file.write_text(results)
            out = io.StringIO()
            with contextlib.redirect_stdout(out):
                test_summary.main(file)
        return out.getvalue().splitlines()

    def test_counts_what_pytest_writes(self):
        self.assertEqual(self.lines_of(PYTEST),
                         ["SKIPPED: 1 (waits): no display", "FAILED: fails", "FAILED: breaks", "1 2 1"])

    def test_colours_of_a_terminal_are_left_out(self):
        self.assertEqual(self.lines_of(PYTEST.replace("assert 1", "\x1b[2massert 1\x1b[22m"))[-1], "1 2 1")

    def test_counts_names_and_reasons(self):
        lines = self.lines_of(RESULTS)
        self.assertEqual(lines[-1], "1 1 3")
        self.assertIn("FAILED: core.B", lines)
        self.assertIn("SKIPPED: 2 (core.C, ...): set MJARM_TEST_DATA", lines)
        self.assertIn("SKIPPED: 1 (core.E): Disabled", lines)


if __name__ == "__main__":
    unittest.main()
