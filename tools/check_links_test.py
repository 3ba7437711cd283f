"""Tests that the check of links finds what it is for. Run: python3 tools/check_links_test.py"""

import pathlib
import tempfile
import unittest

import check_links

ROOT = pathlib.Path(__file__).resolve().parent.parent


class CheckLinksTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name).resolve()

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def faults(self):
        return check_links.check(self.root)[0]

    def test_missing_files_are_named_with_page_and_line(self):
        self.write("docs/a.md", "# A\n\n[there](b.md) and ![picture](images/c.png)\n<img src=\"d.png\" alt=\"\">\n")
        self.write("docs/b.md", "[back](a.md), [up](../e.md)\n")
        self.assertEqual(self.faults(), ["docs/a.md:3: images/c.png: there is no such file", "docs/a.md:4: d.png: there is no such file",
                                         "docs/b.md:1: ../e.md: there is no such file"])

    def test_anchors(self):
        self.write("a.md", "# One `two` (three), four\n\n## 中文 标题：甲\n\n## Same\n## Same\n<a id=\"own\"></a>\n"
                   "[1](#one-two-three-four) [2](#中文-标题甲) [3](#same-1) [4](#own) [5](a.md#same)\n[6](#same-2) [7](a.md#own2)\n")
        self.assertEqual([fault.split(": ")[:2] for fault in self.faults()], [["a.md:9", "#same-2"], ["a.md:9", "a.md#own2"]])

    def test_words_of_a_link_may_wrap(self):
        self.write("a.md", "See [the words\nthat go on](b.md).\n")
        self.assertEqual(self.faults(), ["a.md:2: b.md: there is no such file"])

    def test_code_holds_no_links(self):
        self.write("a.md", "`[x](no.md)`\n```\n[x](no.md)\n# no heading\n```\n~~~\n```\n[x](no.md)\n~~~\n[y](#no-heading)\n")
        self.assertEqual(len(self.faults()), 1)

    def test_other_sites_are_left_alone_and_the_project_is_not_left(self):
        self.write("a.md", "[x](https://example.org/no.md) [y](mailto:a@b.c) [z](../../b.md) [w](/docs/a.md)\n")
        self.assertEqual([fault.split(": ")[2] for fault in self.faults()], ["leads out of the project", "begins with /; name it from the page"])

    def test_folders_and_spaces(self):
        self.write("docs/b c.md", "")
        self.write("a.md", "[x](docs/) [y](docs/b%20c.md)\n")
        self.write("build/c.md", "[x](no.md)")
        self.assertEqual(self.faults(), [])

    def test_the_project(self):
        faults, count = check_links.check(ROOT)
        self.assertEqual(faults, [])
        self.assertGreater(count, 100)


if __name__ == "__main__":
    unittest.main()
