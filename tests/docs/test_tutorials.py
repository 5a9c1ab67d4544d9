"""The Python of each tutorial runs in order and prints what the page shows."""

from __future__ import annotations

import contextlib
import io
import re

import matplotlib as mpl
import pytest

from support.places import ROOT

PAGES = {file.stem: file for file in sorted((ROOT / "docs/tutorials").glob("*.md"))}
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d*)?(?:e[-+]?\d+)?", re.IGNORECASE)


def same(printed: str, shown: str) -> bool:
    """Return True where words agree and numbers differ by no more than one unit of the last digit that is shown."""
    if [" ".join(line.split()) for line in NUMBER.sub("#", printed).splitlines()] != [
        " ".join(line.split()) for line in NUMBER.sub("#", shown).splitlines()
    ]:
        return False
    return all(
        abs(float(found) - float(wanted)) <= 1.001 * unit_of(wanted)
        for found, wanted in zip(NUMBER.findall(printed), NUMBER.findall(shown), strict=True)
    )


def unit_of(number: str) -> float:
    """Return one unit of the last digit of a number that stands on a page; 0 of a whole number."""
    digits, _, power = number.lower().partition("e")
    places = len(digits.partition(".")[2])
    return 10.0 ** (int(power or 0) - places) if places or power else 0.0


def test_numbers_are_compared_to_the_digits_shown():
    assert same("a 1.234 b", "a 1.235 b") and not same("a 1.234 b", "a 1.236 b")
    assert same("1.3e-05\n", "1.2e-05\n") and not same("1.3e-04", "1.2e-05")
    assert not same("512 points", "513 points") and not same("4 slips", "4 jumps")
    assert same("x  -0.5", "x -0.5") and not same("1 2", "1")


@pytest.mark.parametrize("name", PAGES)
def test_a_tutorial_prints_what_its_page_shows(name, tmp_path, monkeypatch):
    mpl.use("Agg")
    import matplotlib.pyplot as plt

    monkeypatch.chdir(tmp_path)
    blocks = BLOCK.findall(PAGES[name].read_text(encoding="utf-8"))
    names: dict[str, object] = {}
    try:
        for place, (language, code) in enumerate(blocks):
            if language != "python":
                continue
            printed = io.StringIO()
            with contextlib.redirect_stdout(printed):
                exec(compile(code, f"{name}.md", "exec"), names)
            following = blocks[place + 1] if place + 1 < len(blocks) else ("", "")
            shown = following[1] if following[0] == "text" else ""
            assert same(printed.getvalue(), shown), f"printed:\n{printed.getvalue()}shown:\n{shown}"
    finally:
        plt.close("all")


@pytest.mark.parametrize("name", PAGES)
def test_a_tutorial_says_what_comes_out_and_has_steps_and_one_exercise(name):
    text = PAGES[name].read_text(encoding="utf-8")
    assert "At the end you will have" in text.split("\n## ")[0]
    headings = re.findall(r"^## (.+)$", text, re.MULTILINE)
    steps = [heading for heading in headings if re.match(r"\d\. ", heading)]
    assert [int(step[0]) for step in steps] == list(range(1, len(steps) + 1)) and 5 <= len(steps) <= 8
    assert headings == [*steps, "Exercise"]
    for target in re.findall(r"\]\(([^)#:]+)\)", text):
        assert (PAGES[name].parent / target).exists(), target
