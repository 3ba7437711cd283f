"""The reference is that of the docstrings as they are, in both languages."""

import pathlib
import runpy

import mjarm

ROOT = pathlib.Path(__file__).parents[2]
TOOL = runpy.run_path(str(ROOT / "tools" / "python_reference.py"))
STUB = pathlib.Path(mjarm.__file__).with_name("_core.pyi")


def test_the_page_is_up_to_date():
    wanted = TOOL["page"](STUB)
    assert (ROOT / "docs" / "python.md").read_text(encoding="utf-8") == wanted, "tools/python_reference.py writes it anew"
    assert all(f"### {name}" in wanted or f"`{name}(" in wanted for name in mjarm.__all__)


def test_the_chinese_page_is_up_to_date():
    chinese = TOOL["catalogue"]()
    wanted = TOOL["page"](STUB, chinese)
    faults = chinese.all_faults()
    assert not faults, "\n".join(faults)
    assert (ROOT / "docs" / "python.zh-CN.md").read_text(encoding="utf-8") == wanted, "tools/python_reference.py writes it anew"
