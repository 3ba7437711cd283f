"""Tests of what the site is made of; they need no Sphinx. Run: python3 tools/site/build_test.py"""

import pathlib
import re
import tempfile
import unittest

import build
import check_layers
import check_links
import cpp_api
from python_reference_test import exact

HEADER = """#pragma once

#include <span>

namespace mjarm {

class Other;

/// Why not.
enum class Why {
  far,   ///< too far
};
/// The word: "far", a_b <x>.
/// @param why  the reason,
///   in short.
/// @return never empty.
[[nodiscard]] std::string_view name(Why why) noexcept;

// A remark.

/// Twice as much.
template <typename T>
inline T twice(T a) {
  return a + a;  // "}"
}
float twice(float a);

/// A solver.
class Solver {
 public:
  explicit Solver(int a = int{1})
      : secret_(a), more_{a} {}  ///< [m] "{"
  void solve();
  bool done() const noexcept {
    if (secret_) { return true; }
    return false;
  }
  int most = 3;

 private:
  int secret_ = 0;
};

inline constexpr double kPi = std::numbers::pi_v<double>(3);

}  // namespace mjarm
"""


class CppTest(unittest.TestCase):
    def test_a_header(self):
        page = cpp_api.header_section("mjarm/core/why.hpp", HEADER)
        self.assertEqual(re.findall(r"^### `(.*)`$", page, re.M), ["Why", "name", "twice", "Solver", "kPi"])
        self.assertIn('The word: "far", a\\_b \\<x\\>.\n\n- `why` — the reason, in short.\n\n- *returns* never empty.\n', page)
        self.assertIn("inline T twice(T a);\nfloat twice(float a);\n", page)
        self.assertIn("inline constexpr double kPi = std::numbers::pi_v<double>(3);", page)
        self.assertIn('  explicit Solver(int a = int{1});  ///< [m] "{"\n  void solve();\n  bool done() const noexcept;\n  int most = 3;\n};', page)
        for gone in ("secret_", "class Other", "A remark", "return a"):
            self.assertNotIn(gone, page)
        self.assertEqual(cpp_api.header_section("mjarm/core/none.hpp", "#pragma once\nnamespace mjarm {\nclass A;\n}\n"), "")

    def test_a_header_in_chinese(self):
        chinese = {"Why not.": "为何不行。", "too far": "太远", "the reason, in short.": "原因，简述。", "never empty.": "从不为空。"}
        page = cpp_api.header_section("mjarm/core/why.hpp", HEADER, lambda text: chinese.get(text, text))
        self.assertIn("为何不行。\n\n```cpp\nenum class Why {\n  far,   ///< 太远\n};\n```", page)
        self.assertIn("- `why` — 原因，简述。\n\n- *返回* 从不为空。\n", page)
        self.assertIn("/// 把数组\n/// 加倍。\nint a(\"//\");  // x", cpp_api.commented('/// Doubles\n/// it.\n///\n/// b\nint a("//");  // x', {
            "Doubles it.": "把数组", "b": "加倍。", "x": "x"}.get))

    def test_every_public_comment_is_there_in_chinese(self):
        faults = [fault for room in check_layers.ALLOWED for fault in cpp_api.room_page(build.ROOT, room, "zh-CN")[1]]
        self.assertEqual(faults, [], "docs/cpp/ROOM.zh-CN.txt")

    def test_no_unit_shape_or_name_is_lost_in_chinese(self):
        for room in check_layers.ALLOWED:
            for (header, english), chinese in cpp_api.Chinese(build.ROOT, room).catalogue.chinese.items():
                self.assertLessEqual(exact(english), exact(chinese), f"{room}: {header}")
                self.assertNotRegex(chinese, r"[\u4e00-\u9fff][,;:.!?]|[,;:!?] ?[\u4e00-\u9fff]", f"{room}: {header}: punctuation")

    def test_nothing_of_a_public_header_is_lost(self):
        for room in check_layers.ALLOWED:
            self.assertIn(room, cpp_api.TEXTS)
            for file in cpp_api.public_headers(build.ROOT, room):
                text = file.read_text(encoding="utf-8")
                section = cpp_api.header_section("x.hpp", text)
                for name in re.findall(r"^(?:struct|enum class|class) (?:\[\[\w+\]\] )?(\w+)[^;]*\{", text, re.M):
                    self.assertRegex(section, rf"(?:struct|class) (?:\[\[\w+\]\] )?{name}\b", f"{file}: {name}")


class PagesTest(unittest.TestCase):
    def stage(self, language, out="/nowhere"):
        return build.Stage(language, pathlib.Path("/nowhere"), pathlib.Path(out))

    def link(self, language, page, target):
        name = page.removesuffix(".md").removesuffix(".zh-CN")
        return self.stage(language).with_links(f"see [it]({target}).", build.ROOT / page, name)

    def test_links_between_the_languages(self):
        self.assertEqual(self.link("en", "docs/serve.md", "planning.md#x"), "see [it](../docs/planning.md#x).")
        self.assertEqual(self.link("en", "docs/serve.md", "serve.zh-CN.md"), 'see <a href="../../zh-CN/docs/serve.html">it</a>.')
        self.assertEqual(self.link("zh-CN", "docs/serve.zh-CN.md", "serve.md"), 'see <a href="../../en/docs/serve.html">it</a>.')
        self.assertEqual(self.link("zh-CN", "docs/serve.zh-CN.md", "perception.zh-CN.md"), "see [it](../docs/perception.md).")
        self.assertEqual(self.link("en", "docs/serve.md", "../README.md"), "see [it](../index.md).")

    def test_links_to_files(self):
        with tempfile.TemporaryDirectory() as out:
            stage = self.stage("en", out)
            line = stage.with_links("see [it](../examples/01_forward_kinematics.cpp), `[x](y)`", build.ROOT / "docs/serve.md", "docs/serve")
            self.assertEqual(line, 'see <a href="../../files/examples/01_forward_kinematics.cpp.txt">it</a>, `[x](y)`')
            self.assertTrue((pathlib.Path(out) / "files/examples/01_forward_kinematics.cpp.txt").is_file())
            self.assertIn("files/examples/index.html", stage.with_links("[all](../examples/)", build.ROOT / "docs/serve.md", "docs/serve"))

    def test_chinese_goes_on_without_a_blank(self):
        self.assertEqual(build.without_blanks_in_chinese("甲\n乙，\n丙\n\n丁\n`a`\n- 戊"), "甲乙，丙\n\n丁\n`a`\n- 戊")
        self.assertEqual(build.without_blanks_in_chinese("## 甲\n乙\n丙"), "## 甲\n乙丙")

    def test_every_page_is_in_the_site_in_both_languages(self):
        found = {page.relative_to(build.ROOT).as_posix()[:-3] for page in check_links.pages_of(build.ROOT)}
        chinese = {page.removesuffix(".zh-CN") for page in found if page.endswith(".zh-CN")}
        english = {page for page in found if not page.endswith(".zh-CN")} - {"docs/roadmap"}  # that is for those who build mjarm
        self.assertEqual(sorted(english - {"README"}), sorted(build.pages()))
        self.assertEqual(english, chinese)

    def test_tables_of_benchmarks_are_the_same_in_both_languages(self):
        def tables(page):
            return re.findall(r"<!-- (\w+): begin -->\n(.*?)<!-- \1: end -->", (build.ROOT / "docs" / page).read_text(encoding="utf-8"), re.S)
        self.assertEqual(len(tables("benchmarks.md")), 9)
        self.assertEqual(tables("benchmarks.md"), tables("benchmarks.zh-CN.md"))

    def test_messages_come_whole(self):
        topics = dict(build.messages())
        self.assertIn(("{}: no such file", "{}：文件不存在"), topics["core"])
        count = sum(file.read_text(encoding="utf-8").count("\nMJARM_MSG(") for file in build.message_files())
        self.assertEqual(sum(len(pairs) for pairs in topics.values()), count)

    def test_links_of_the_site_are_followed(self):
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder).resolve()
            (out / "a.html").write_text('<a href="b.html#x"></a><a href="b.html#y"></a><a href="c.html"></a><a href="https://example.org"></a>'
                                        '<script src="https://example.org/a.js"></script><img src="d.png">')
            (out / "b.html").write_text('<p id="x">')
            (out / "s.css").write_text("a { background: url(//example.org/a.png); }")
            self.assertEqual(sorted(build.link_faults(out)), ["a.html: b.html#y: no such anchor", "a.html: c.html: no such file", "a.html: d.png: no such file",
                                                              "a.html: loads https://example.org/a.js", "s.css: loads from elsewhere"])


if __name__ == "__main__":
    unittest.main()
