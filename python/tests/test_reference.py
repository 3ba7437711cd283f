"""The reference is that of the docstrings as they are."""

import pathlib
import runpy

import mjarm

ROOT = pathlib.Path(__file__).parents[2]


def test_the_page_is_up_to_date():
    tool = runpy.run_path(str(ROOT / "tools" / "python_reference.py"))
    wanted = tool["page"](pathlib.Path(mjarm.__file__).with_name("_core.pyi"))
    assert (ROOT / "docs" / "python.md").read_text(encoding="utf-8") == wanted, "tools/python_reference.py writes it anew"
    assert all(f"### {name}" in wanted or f"`{name}(" in wanted for name in mjarm.__all__)
