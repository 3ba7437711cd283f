"""Tests of how the reference of Python becomes Chinese; they need no module. Run: python3 tools/python_reference_test.py"""

import ast
import re
import unittest

import python_reference

DOC = '''
def move(q):
    """Moves the arm
    to `q`.

        move(q)    # at once

    Parameters
    ----------
    q : array_like, shape (dof,)
        Joint values
        [rad or m].

    Raises
    ------
    BadInput
    """
'''
CHINESE = """What is above the first heading is for readers.

## *
Parameters:
  参数：
Raises:
  异常：
array_like, shape (dof,)
  array_like，形状 (dof,)

## move
Moves the arm to `q`.
  使机械臂运动到 `q`。
at once
  立即
Joint values [rad or m].
  关节值 [rad 或 m]。
"""


def exact(text):
    """Code, words in quotes, shapes, units and numbers: what no translation may change."""
    text = text.replace(" or ", " 或 ")
    return {*re.findall(r"`[^`]+`", text), *re.findall(r'"[^"]+"', text), *re.findall(r"\((?:\w+, )*\w+,\)|\(\w+(?:, \w+)+\)", text),
            *re.findall(r"\[[A-Za-z][\w/^]*|(?<=或 )[A-Za-z][\w/^ ]*\]", text), *re.findall(r"(?<![\w.])-?\d+(?:\.\d+)?", text)}


class CatalogueTest(unittest.TestCase):
    def translated(self, chinese, doc=DOC):
        docstrings = python_reference.Docstrings(chinese, "zh.txt")
        return docstrings("move", python_reference.doc_of(ast.parse(doc).body[0])), docstrings.all_faults()

    def test_what_is_code_or_a_list_stays_so(self):
        text, faults = self.translated(CHINESE)
        self.assertEqual(faults, [])
        self.assertEqual(text, "使机械臂运动到 `q`。\n\n    move(q)    # 立即\n\n参数：\n\n- `q`（array_like，形状 (dof,)）：关节值 [rad 或 m]。\n\n异常：\n\n- `BadInput`")

    def test_a_docstring_that_was_changed_is_named(self):
        _, faults = self.translated(CHINESE, DOC.replace("Joint values", "Angles"))
        self.assertEqual(faults, ["zh.txt: move: has no Chinese: Angles [rad or m].", "zh.txt:16: move: nothing says this: Joint values [rad or m]."])

    def test_english_alone_is_a_fault(self):
        _, faults = self.translated(CHINESE.replace("  立即\n", ""))
        self.assertEqual(faults, ["zh.txt: move: has no Chinese: at once"])

    def test_what_stands_twice_is_a_fault(self):
        _, faults = self.translated(CHINESE + "at once\n  马上\n")
        self.assertEqual(faults, ["zh.txt:18: move: stands twice: at once"])

    def test_what_holds_everywhere_gives_way_to_what_holds_here(self):
        text, faults = self.translated(CHINESE.replace("## move\n", "at once\n  马上\n\n## move\n"))
        self.assertIn("# 立即", text)
        self.assertEqual(faults, ["zh.txt:11: *: nothing says this: at once"])

    def test_no_unit_shape_or_name_is_lost(self):
        catalogue = python_reference.docstrings()
        self.assertGreater(len(catalogue.chinese), 400)
        for (name, english), chinese in catalogue.chinese.items():
            if name != "page":  # which has links of its own
                self.assertLessEqual(exact(english), exact(chinese), name)
            self.assertNotRegex(chinese, r"[\u4e00-\u9fff][,;:.!?]|[,;:!?] ?[\u4e00-\u9fff]", f"{name}: punctuation")

    def test_the_pages_have_the_same_names(self):
        english, chinese = (re.findall(r"(?m)^(##.*|\s*- `[^`]*`)", (python_reference.ROOT / "docs" / page).read_text(encoding="utf-8"))
                            for page in ("python.md", "python.zh-CN.md"))
        self.assertEqual(english, chinese)


if __name__ == "__main__":
    unittest.main()
