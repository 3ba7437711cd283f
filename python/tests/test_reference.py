"""The reference is that of the docstrings as they are, in both languages."""

import pathlib
import sys

import mjarm

ROOT = pathlib.Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tools"))

import python_reference  # noqa: E402

STUB = pathlib.Path(mjarm.__file__).with_name("_core.pyi")


def test_the_page_is_up_to_date():
    wanted = python_reference.page(STUB)
    assert (ROOT / "docs" / "python.md").read_text(encoding="utf-8") == wanted, "tools/python_reference.py writes it anew"
    assert all(f"### {name}" in wanted or f"`{name}(" in wanted for name in mjarm.__all__)


def test_the_chinese_page_is_up_to_date():
    chinese = python_reference.docstrings()
    wanted = python_reference.page(STUB, chinese)
    faults = chinese.all_faults()
    assert not faults, "\n".join(faults)
    assert (ROOT / "docs" / "python.zh-CN.md").read_text(encoding="utf-8") == wanted, "tools/python_reference.py writes it anew"
