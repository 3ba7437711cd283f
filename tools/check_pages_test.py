"""Tests that the check of pages finds what it is for. Run: python3 tools/check_pages_test.py"""

import contextlib
import io
import pathlib
import sys
import tempfile
import unittest

import check_pages

PROGRAM = """#!/bin/sh
case $1 in
  fk) echo "pos  -0.134  0.492 0.488"; echo "quat 0 0 1 0"; echo "took 12.3 ms" ;;
  ik) echo "out of reach by 0.25 m" >&2; exit 1 ;;
  ask) cat; echo "asked" ;;
  sleep) sleep 60 ;;
  say) shift; echo "$LANG ${DISPLAY-no display} $*" ;;
esac
"""


class CheckPagesTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name).resolve()
        self.program = self.root / "program"
        self.program.write_text(PROGRAM)
        self.program.chmod(0o755)
        (self.root / "models").mkdir()
        (self.root / "models" / "a.xml").write_text("<mujoco/>\n")

    def write(self, name, text):
        page = self.root / name
        page.parent.mkdir(parents=True, exist_ok=True)
        page.write_text(text, encoding="utf-8")
        return page

    def run_page(self, text, name="docs/a.md", options=()):
        """(exit code, lines printed)"""
        page = self.write(name, text)
        out, arguments = io.StringIO(), sys.argv
        sys.argv = ["check_pages.py", "--program", str(self.program), "--root", str(self.root), *options, str(page)]
        try:
            with contextlib.redirect_stdout(out), self.assertRaises(SystemExit) as end:
                check_pages.main()
        finally:
            sys.argv = arguments
        return end.exception.code, out.getvalue().splitlines()

    def assert_counts(self, text, counts, **more):
        code, lines = self.run_page(text, **more)
        self.assertEqual(lines[-1], counts, "\n".join(lines))
        self.assertEqual(code, 0 if ", 0 failed" in counts else 1)
        return "\n".join(lines[:-1])

    def test_a_program_that_is_not_there_is_told(self):
        self.program.unlink()
        with contextlib.redirect_stderr(io.StringIO()) as told:
            code, lines = self.run_page("```sh\nmjarm\n```\n")
        self.assertEqual((code, lines), (2, []))
        self.assertIn(f'"{self.program}" is no program', told.getvalue())

    def test_commands_run_in_order_in_one_folder(self):
        self.assert_counts("```sh\n# a comment\necho one > f\n\n./dev fk --x \\\n  1\n```\nwords\n```sh\ncat f\nmkdir d\ncd d\n"
                           "cat <<'EOF'\nhere\nEOF\nls ../f ../models/a.xml\n```\n```text\none\nhere\n../f\n```\n", "8 passed, 0 failed, 0 skipped")

    def test_a_page_for_learners_starts_in_an_empty_folder(self):
        found = self.assert_counts("```sh\nls models\n```\n", "0 passed, 1 failed, 0 skipped", name="docs/learn/01_a.md")
        self.assertIn("docs/learn/01_a.md:2: exit code 2", found)

    def test_what_is_printed_is_compared(self):
        fk = "```sh\nmjarm fk\n```\n\n```text\n"
        self.assert_counts(fk + "pos -0.134 0.49 0.489\n...\ntook 12 ms\n```\n", "2 passed, 0 failed, 0 skipped")
        self.assert_counts(fk + "pos -0.1... 0.488\ntook ... ms\n```\n", "2 passed, 0 failed, 0 skipped")
        found = self.assert_counts(fk + "quat 0 0 1 0\npos -0.134 0.492 0.488\n```\n", "1 passed, 1 failed, 0 skipped")
        self.assertIn("docs/a.md:7: not printed\n    expected: pos -0.134 0.492 0.488\n    nearest:  took 12.3 ms", found)
        found = self.assert_counts(fk + "pos -0.134 0.480 0.488\n```\n", "1 passed, 1 failed, 0 skipped")
        self.assertIn("nearest:  pos  -0.134  0.492 0.488", found)
        self.assert_counts("```sh\nmjarm fk\n```\nwords\n```text\nsomething else\n```\n", "1 passed, 0 failed, 0 skipped")

    def test_files_that_the_reader_saves(self):
        text = "```yaml\n# own.yaml\nrobot: a  # b\n```\n```xml\n<!-- own.xml -->\n<a/>\n```\n```xml\n<!-- what it is -->\n```\n```sh\ncat own.yaml own.xml\n```\n"
        self.assert_counts(text + "```text\n# own.yaml\nrobot: a  # b\n<a/>\n```\n", "2 passed, 0 failed, 0 skipped")
        self.write("docs/a.zh-CN.md", text.replace("# b", "# 乙"))
        self.assert_counts(text, "2 passed, 0 failed, 0 skipped")
        self.write("docs/a.zh-CN.md", text.replace("robot: a", "robot: b"))
        self.assert_counts(text, "1 passed, 1 failed, 0 skipped")

    def test_exit_codes(self):
        self.assert_counts("```sh\nmjarm ik\n```\n", "0 passed, 1 failed, 0 skipped")
        self.assert_counts("```sh\nmjarm fk\nmjarm ik\n```\n```text\nout of reach by 0.25 m\n```\n", "3 passed, 0 failed, 0 skipped")
        self.assert_counts("```sh\nmjarm ik\nmjarm fk\n```\n```text\nquat 0 0 1 0\n```\n", "2 passed, 1 failed, 0 skipped")
        self.assert_counts("```sh\nmjarm ik  # exit code 1\nmjarm ik  # 退出码 1\nmjarm fk  # exit code 1\n```\n", "2 passed, 1 failed, 0 skipped")
        found = self.assert_counts("```sh\nmjarm ik (\n```\n", "0 passed, 1 failed, 0 skipped")
        self.assertIn("syntax error", found)

    def test_a_shell_that_ends_is_told_and_replaced(self):
        self.assert_counts("```sh\nexit 3\necho there\n```\n", "1 passed, 1 failed, 0 skipped")

    def test_nothing_waits_for_ever(self):
        self.assert_counts("```sh\nmjarm ask\n```\n", "1 passed, 0 failed, 0 skipped")
        found = self.assert_counts("```sh\nmjarm sleep\nmjarm fk\n```\n", "1 passed, 1 failed, 0 skipped", options=["--seconds", "0.5"])
        self.assertIn("docs/a.md:2: took longer than 0.5 s", found)
        self.assert_counts("<!-- up to 60 s -->\n```sh\nsleep 1\n```\n", "1 passed, 0 failed, 0 skipped", options=["--seconds", "0.5"])

    def test_blocks_of_python_share_a_process_and_the_folder(self):
        self.assert_counts("```sh\necho 7 > f\n```\n```python\nx = int(open('f').read())\nprint('x', x)\n```\n```text\nx 7\n```\n"
                           "```python\nprint(x + 1)\n```\n```text\n8\n```\n", "5 passed, 0 failed, 0 skipped")
        found = self.assert_counts("```python\na = 1\n\nassert a == 2\n```\n", "0 passed, 1 failed, 0 skipped")
        self.assertIn("line 4", found)
        self.assertIn("AssertionError", found)
        self.assert_counts("```python\nimport sys\nsys.exit(1)\n```\n```python\nsys.exit()\n```\n", "1 passed, 1 failed, 0 skipped")

    def test_what_cannot_run_here_is_left_out_with_its_reason(self):
        text = ("```sh\n./dev test\n./dev check\n./dev check a\npip install mjarm\nmjarm view ur5e\nmjarm serve ur5e\nmjarm bench ik\n./dev\n"
                "python3 -m venv arm\n. arm/bin/activate\ncd x && npm ci\n```\n\n<!-- not run: needs a robot -->\n```sh\nfalse\n```\n```text\nx\n```\n")
        found = self.assert_counts(text, "1 passed, 0 failed, 12 skipped")
        self.assertIn("docs/a.md:17: false: needs a robot", found)
        self.assertIn("docs/a.md:2: ./dev test: a command of ./dev itself", found)

    def test_tables(self):
        text = "| `./dev fk` | `./dev NAME --help`, `mjarm ik` |\n| `./dev ik --robot my_arm.urdf` | `mjarm fk` |\n`./dev ik`\n"
        self.assert_counts(text, "0 passed, 0 failed, 0 skipped")
        self.assert_counts(text, "2 passed, 1 failed, 2 skipped", options=["--tables"])
        self.assert_counts("| `mjarm ik` | <!-- exit code 1 --> |\n| `mjarm fk` | <!-- exit code 1 --> |\n", "1 passed, 1 failed, 0 skipped", options=["--tables"])
        for seconds, counts in ((1, "0 passed, 1 failed, 0 skipped"), (30, "1 passed, 0 failed, 0 skipped")):
            self.assert_counts(f"| `mjarm fk && sleep 2` <!-- up to {seconds} s --> |\n", counts, options=["--tables"])

    def test_the_reader_has_no_display_and_a_language(self):
        text = "```sh\nmjarm say\n```\n```text\n{} no display\n```\n"
        self.assert_counts(text.format("C.UTF-8"), "2 passed, 0 failed, 0 skipped")
        self.assert_counts(text.format("zh_CN.UTF-8"), "2 passed, 0 failed, 0 skipped", name="docs/a.zh-CN.md")

    def test_both_languages_run_the_same(self):
        text = "```sh\nmjarm say hello  # greet\n```\n```python\n# one\nprint(f\"{1 + 1} points\", 'x')\n```\n"
        good = "```sh\nmjarm say 你好  # 问好\n```\n```python\nprint(f\"共 {1 + 1} 个点\", 'x')\n```\n"
        own = good.replace("```python\n", "```python\nmjarm.set_language('zh')\n").replace("你好", "你好 --lang zh-CN")
        keyed = "```python\nprint(about['{}'])\n```\n"
        self.assertIsNone(check_pages.twin_fault(self.write("docs/c.md", keyed.format("en")), self.write("docs/c.zh-CN.md", keyed.format("zh"))))
        self.assertIsNotNone(check_pages.twin_fault(self.write("docs/c.md", keyed.format("en")), self.write("docs/c.zh-CN.md", keyed.format("de"))))
        self.assertIsNone(check_pages.twin_fault(self.write("docs/b.md", text), self.write("docs/b.zh-CN.md", own)))
        for other, failed in ((good, 0), (good.replace("1 + 1", "1 + 2"), 1), (good.replace("'x'", "'y'"), 1), (good.replace("say", "fk"), 1),
                              ("```sh\nmjarm say 你好\n```\n", 1), (good.replace("```python", "```sh\nmjarm fk\n```\n```python"), 1)):
            self.write("docs/a.zh-CN.md", other)
            found = self.assert_counts(text, f"{3 - failed} passed, {failed} failed, 0 skipped")
            self.assertEqual("docs/a.zh-CN.md:" in found, bool(failed))


class SameLineTest(unittest.TestCase):
    def test_numbers(self):
        for expected, printed, same in (("x 1.00", "x 1.01", True), ("x 1.00", "x 1.02", False), ("x 100", "x 101", True), ("x 100", "x 102", False),
                                        ("0.0007 mm", "0.0008 mm", True), ("0.0007 mm", "0.0009 mm", False), ("1e-12", "3e-11", True),
                                        ("1.5e-3", "1.6e-3", True), ("1.5e-3", "1.7e-3", False), ("a 1", "b 1", False), ("1 a", "-1 a", False),
                                        ("a  1", " a 1 ", True), ("1 2", "1 2 3", False), ("点 3 个", "点 3 个", True)):
            self.assertEqual(check_pages.same_line(expected, printed), same, (expected, printed))

    def test_dots_stand_for_anything(self):
        for expected, printed, same in (("wrote ...", "wrote /tmp/a b", True), ("wrote ... 5", "wrote x 7", False), ("... done", "all done", True),
                                        ("a ... b", "a c", False), ("1.0 ... 2.0", "1.0 x 2.1", True), ("1.0 ... 2.0", "1.0 x 2.2", False), ("  a  ... b", "  a 1   b", True)):
            self.assertEqual(check_pages.same_line(expected, printed), same, (expected, printed))


if __name__ == "__main__":
    unittest.main()
