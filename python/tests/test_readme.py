"""The pages of the package run word for word."""

import pathlib
import re

import numpy as np
import pytest

import mjarm

PAGES = [pathlib.Path(__file__).parent.parent / name for name in ("README.md", "README.zh-CN.md")]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_page(page, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL)
    assert len(blocks) == 5
    world = {}
    for block in blocks:
        exec(compile(block, str(page), "exec"), world)
    assert len(world["t"]) == len(world["q"]) and isinstance(world["plan"], mjarm.Plan)
    assert world["run"].ok and (tmp_path / "run.svg").exists()
    assert np.linalg.norm(world["robot"].fk(world["data"].qpos).pos - world["robot"].fk(world["q"][-1]).pos) < 1e-5
    assert "1.090" in capsys.readouterr().out
