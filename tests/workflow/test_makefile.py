"""The Makefile gives targets and tiers to the workflow as they are typed."""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess

import pytest

from support.places import ROOT


@pytest.fixture
def makefile(tmp_path):
    """The Makefile in a folder that is set up, with what make would run for some arguments."""
    shutil.copy(ROOT / "Makefile", tmp_path)
    for name in ("environment.lock.txt", "pyproject.toml", ".venv/.ready"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).touch()

    def command(*arguments):
        alone = {name: value for name, value in os.environ.items() if name not in ("MAKEFLAGS", "MAKELEVEL", "MFLAGS")}
        shown = subprocess.run(
            ["make", "-n", *arguments], cwd=tmp_path, env=alone, capture_output=True, text=True, check=True
        )
        return shlex.split(shown.stdout.splitlines()[-1])

    return command


@pytest.mark.parametrize(
    "word", ["quick", "a b", "a;id", "$(id)", "$(shell id)", "`id`", "a'b", 'a"b', "$HOME", "a&b", "*"]
)
@pytest.mark.parametrize("name", ["TIER", "tier"])
def test_a_tier_reaches_the_workflow_as_it_is_typed(makefile, name, word):
    assert makefile("fig_3_2", f"{name}={word}")[3:] == ["fig_3_2", "--config", f"tier={word}"]


@pytest.mark.parametrize("word", ["fig;id", "a b", "a'b", "`id`"])
def test_a_target_reaches_the_workflow_as_it_is_typed(makefile, word):
    assert makefile(word)[3:] == [word]
