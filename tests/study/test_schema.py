"""The schema of the settings knows every key of the chapters, and no other."""

from __future__ import annotations

import copy
import json

import jsonschema
import pytest

from contactsim import cli
from contactsim.study.plain_yaml import load_yaml
from contactsim.study.schema import chapter_schema
from support.places import ROOT

CHAPTERS = sorted((ROOT / "config").glob("ch*.yaml"))
VALIDATOR = jsonschema.Draft202012Validator(chapter_schema())


@pytest.mark.parametrize("file", CHAPTERS, ids=lambda file: file.stem)
def test_every_chapter_has_the_keys_of_the_schema_and_names_it_to_editors(file):
    assert list(VALIDATOR.iter_errors(load_yaml(file))) == []
    assert file.read_text(encoding="utf-8").startswith("# yaml-language-server: $schema=schema.json\n")


@pytest.mark.parametrize(
    ("place", "key", "value"),
    [
        (("studies", "indentation"), "pints", 3),
        (("studies", "indentation", "surface"), "radios", 3.0),
        (("studies", "indentation", "surface"), "kind", "cylindre"),
        (("studies", "indentation", "cohesive_zone"), "work", 3.0),
        (("studies", "indentation", "path"), "aproach", [0.0, 1.0]),
        (("figures", "fig_4_2"), "colour", "red"),
        (("figures", "jump_and_pull_off", "film"), "speed", 8.0),
        ((), "figure", {}),
    ],
)
def test_a_key_or_kind_that_does_not_exist_is_marked(place, key, value):
    content = copy.deepcopy(load_yaml(ROOT / "config/ch4.yaml"))
    section = content
    for name in place:
        section = section[name]
    section[key] = value
    assert list(VALIDATOR.iter_errors(content))


def test_the_schema_in_the_config_is_that_of_the_code(capsys):
    cli.main(["schema"])
    told = capsys.readouterr().out
    kept = (ROOT / "config/schema.json").read_text(encoding="utf-8")
    assert json.loads(told) == chapter_schema()
    assert kept == told, "contactsim schema > config/schema.json"
