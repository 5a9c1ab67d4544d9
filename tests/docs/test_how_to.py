"""The Python of each how-to page runs in order, in a folder that has the files that the page says to save."""

from __future__ import annotations

import ast
import re
import sys
import textwrap
from pathlib import Path
from types import ModuleType

import matplotlib as mpl
import numpy as np
import pytest
import xarray as xr

from support.places import ROOT

PAGES = {file.stem: file for file in sorted((ROOT / "docs/how_to").glob("*.md"))}
BLOCK = re.compile(r"^( *)```python\n(.*?)^\1```$", re.MULTILINE | re.DOTALL)
LINES = xr.Dataset(
    {"kappa_mean": (("hurst_exponent", "reduced_pressure"), np.full((2, 2), 1.9))},
    {"hurst_exponent": [0.2, 0.8], "reduced_pressure": [0.001, 0.1]},
)
DATASETS = {
    "rerun_what_changed": {f"{folder}/datasets/ch7_own_lines.nc": LINES for folder in ("before", "results/quick")},
}
"""Datasets that the commands of a page make before its Python reads them."""
SAVED = re.compile(r"Save this as `(\w+\.py)`")


def python_blocks(text: str) -> list[tuple[str, str]]:
    """Each block of Python with the name under which the words before it say to save it; empty if they do not."""
    blocks, end = [], 0
    for block in BLOCK.finditer(text):
        names = SAVED.findall(text[end : block.start()])
        blocks.append((names[-1] if names else "", textwrap.dedent(block[2])))
        end = block.end()
    return blocks


def unknown_members(code: str, names: dict[str, object]) -> set[str]:
    """Members of modules that a block names and that do not exist, also in functions that it only defines."""
    members = (node for node in ast.walk(ast.parse(code)) if isinstance(node, ast.Attribute))
    named = ((node.value.id, node.attr) for node in members if isinstance(node.value, ast.Name))
    modules = {name: value for name, value in names.items() if isinstance(value, ModuleType)}
    return {f"{name}.{member}" for name, member in named if name in modules and not hasattr(modules[name], member)}


def test_every_block_of_python_is_found():
    for name, file in PAGES.items():
        text = file.read_text(encoding="utf-8")
        assert len(python_blocks(text)) == text.count("```python"), name
    assert sum(len(python_blocks(file.read_text(encoding="utf-8"))) for file in PAGES.values()) >= 15


@pytest.mark.parametrize("name", [name for name, file in PAGES.items() if "```python" in file.read_text("utf-8")])
def test_the_python_of_a_page_runs(name, tmp_path, monkeypatch):
    mpl.use("Agg")
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(str(tmp_path))
    for place, data in DATASETS.get(name, {}).items():
        Path(place).parent.mkdir(parents=True)
        data.to_netcdf(place)
    before = set(sys.modules)
    monkeypatch.setitem(sys.modules, name, ModuleType(name))  # dataclasses look up the module of their class
    names: dict[str, object] = {"__name__": name}
    try:
        for saved, code in python_blocks(PAGES[name].read_text(encoding="utf-8")):
            if saved:
                Path(saved).write_text(code, encoding="utf-8")
            exec(compile(code, f"{name}.md", "exec"), names)
            assert unknown_members(code, names) == set()
    finally:
        for module in set(sys.modules) - before:
            if str(tmp_path) in str(getattr(sys.modules[module], "__file__", "")):
                del sys.modules[module]
