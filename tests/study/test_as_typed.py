"""An error of settings shows the value as it is typed, with file and line."""

from __future__ import annotations

import pytest

from contactsim.errors import NOTHING, InputError
from contactsim.study.as_typed import as_typed
from contactsim.study.plain_yaml import load_yaml
from contactsim.study.tier_overrides import TieredFile

CHAPTER = """studies:
  rough: &rough
    title: Rough
    surface: {kind: flat, length: 1.0e-3}
    load: {mean_pressure: [1.0e-1, 2.50,
                           3.0e-2]}
    vary: {surface.length: [1.0e+2, ~]}
  other:
    <<: *rough
    title: >-
      two
      lines
panels:
- {size: [1, 2]}
- {size: [3, 4]}
"""
TIERS = "quick:\n  studies:\n    rough: {points: 1.28e+2}\n  trials: {errors: [1.0e-9]}\n"


@pytest.fixture
def chapter(tmp_path):
    """Write a chapter and the tiers beside it."""
    (tmp_path / "tiers.yaml").write_text(TIERS, encoding="utf-8")
    path = tmp_path / "ch9.yaml"
    path.write_text(CHAPTER, encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("key", "value", "typed", "line"),
    [
        ("studies.rough.surface.length", 0.001, "1.0e-3", 4),
        ("studies.rough.load.mean_pressure", [0.1, 2.5, 0.03], "[1.0e-1, 2.50, 3.0e-2]", 5),
        ("studies.rough.load.mean_pressure", 0.03, "3.0e-2", 6),
        ("studies.rough.vary.surface.length", [100.0, None], "[1.0e+2, ~]", 7),
        ("studies.rough.surface.length", None, "~", 7),
        ("studies.rough.surface", {"kind": "flat", "length": 0.001}, "{kind: flat, length: 1.0e-3}", 4),
        ("studies.other.surface.length", 0.001, "1.0e-3", 4),
        ("studies.other.title", "two lines", ">- two lines", 10),
        ("panels.1.size", [3, 4], "[3, 4]", 15),
    ],
)
def test_a_value_is_shown_as_it_stands_in_the_file(chapter, key, value, typed, line):
    error = as_typed(InputError(key, value, "another", chapter))
    assert str(error) == f"{chapter}, line {line}: {key}: got {typed}; allowed: another"


@pytest.mark.parametrize(
    ("file", "key", "value", "typed", "line", "name"),
    [
        ("ch9.yaml", "studies.rough.points", 128.0, "1.28e+2", 3, "tiers.yaml"),
        ("ch9.yaml", "studies.rough.surface.length", 0.001, "1.0e-3", 4, "ch9.yaml"),
        ("trials.yaml", "errors", 1e-9, "1.0e-9", 4, "tiers.yaml"),
    ],
)
def test_a_value_of_a_tier_is_shown_with_the_file_that_holds_it(chapter, file, key, value, typed, line, name):
    tiered = TieredFile(chapter.with_name(file), "quick")
    error = as_typed(InputError(key, value, "another", tiered))
    assert str(error) == f"{tiered}, line {line} of {chapter.with_name(name)}: {key}: got {typed}; allowed: another"


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("studies.rough.points", NOTHING),
        ("studies.rough.title", "Smooth"),
        ("nowhere", 5),
        ("studies.rough.title.x", 1),
    ],
)
def test_a_value_that_stands_nowhere_is_shown_as_it_is(chapter, key, value):
    error = InputError(key, value, "another", chapter)
    assert as_typed(error) is error
    assert as_typed(InputError(key, value, "another", chapter.with_name("gone.yaml"))).value is value
    assert as_typed(InputError(key, value, "another")).value is value


def test_the_example_is_plain_yaml(chapter):
    assert load_yaml(chapter)["studies"]["other"]["surface"]["length"] == 1e-3
