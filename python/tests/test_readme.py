"""The pages of the package run word for word."""

import pathlib
import re

import pytest

import mjarm

PAGES = [pathlib.Path(__file__).parent.parent / name for name in ("README.md", "README.zh-CN.md")]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_page(page, capsys):
    blocks = re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL)
    assert len(blocks) == 3
    world = {}
    for block in blocks:
        exec(compile(block, str(page), "exec"), world)
    assert len(world["t"]) == len(world["q"]) and isinstance(world["plan"], mjarm.Plan)
    assert "1.090" in capsys.readouterr().out
