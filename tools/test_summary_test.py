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


class SummaryTest(unittest.TestCase):
    def test_counts_names_and_reasons(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "results.xml"
            file.write_text(RESULTS)
            out = io.StringIO()
            with contextlib.redirect_stdout(out):
                test_summary.main(file)
        lines = out.getvalue().splitlines()
        self.assertEqual(lines[-1], "1 1 3")
        self.assertIn("FAILED: core.B", lines)
        self.assertIn("SKIPPED: 2 (core.C, ...): set MJARM_TEST_DATA", lines)
        self.assertIn("SKIPPED: 1 (core.E): Disabled", lines)


if __name__ == "__main__":
    unittest.main()
