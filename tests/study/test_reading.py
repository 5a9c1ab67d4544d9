from __future__ import annotations

import math
import pickle
from copy import deepcopy
from dataclasses import dataclass, field

import pytest
import yaml

from contactsim.errors import InputError
from contactsim.study.reading import Key, choice, keys_of, listed, mapping, number, positive, read, text
from contactsim.study.reading import whole as whole_number
from contactsim.study.tier_overrides import overlaid

KEYS = {
    "length": Key(number, "a number of nm"),
    "step": Key(positive, "a positive number", 0.5),
    "points": Key(whole_number(2), "a whole number, 2 or more", 8),
    "title": Key(text, "a line of text", "none"),
    "kind": Key(choice(("hill", "dale")), "one of hill, dale", "hill"),
    "loads": Key(listed(number), "a list of numbers", None),
    "inner": Key(mapping, "a mapping", None),
}


def refusal(section, keys=KEYS):
    """The error of reading a section that stands at `part` in a file."""
    with pytest.raises(InputError) as caught:
        read(section, keys, "file.yaml", "part")
    return caught.value


def assert_says(error, file, key, value, *allowed):
    """The parts of the error, and that its message shows all of them."""
    assert (str(error.file), error.key) == (str(file), key)
    assert error.value is value or error.value == value
    for part in (str(file), key, *allowed):
        assert part in str(error)


def test_what_is_given_is_read_and_what_is_not_gets_its_default():
    values = read({"length": 3, "title": "Alps"}, KEYS, "file.yaml")
    defaults = {"step": 0.5, "points": 8, "kind": "hill", "loads": None, "inner": None}
    assert values == {"length": 3.0, "title": "Alps"} | defaults


def test_a_whole_number_given_for_a_real_one_becomes_real():
    assert type(read({"length": 3}, KEYS, "file.yaml")["length"]) is float


def test_an_unknown_key_is_refused_by_name_with_the_known_ones():
    assert_says(refusal({"length": 1.0, "lenght": 2.0}), "file.yaml", "part.lenght", 2.0, *KEYS)


def test_a_missing_key_is_refused_with_what_it_wants():
    assert_says(refusal({}), "file.yaml", "part.length", "nothing", "a number of nm", "missing")


def test_at_the_top_of_a_file_keys_have_no_prefix():
    with pytest.raises(InputError) as caught:
        read({}, KEYS, "file.yaml")
    assert caught.value.key == "length"


@pytest.mark.parametrize("section", [None, [], "text", 5, [("length", 1.0)]])
def test_a_section_that_is_no_mapping_is_refused_with_its_keys(section):
    assert_says(refusal(section), "file.yaml", "part", section, "a mapping with keys", *KEYS)


@pytest.mark.parametrize(
    ("key", "value"),
    [
        *[("length", value) for value in ("long", None, [1.0], {"nm": 1.0}, True, math.nan, math.inf, -math.inf)],
        *[("step", value) for value in (0, -1.0, 0.0, False, math.nan, "1.0")],
        *[("points", value) for value in (1, -3, 2.0, "8", True, None, [8])],
        *[("title", value) for value in (5, True, None, ["a"])],
        *[("kind", value) for value in ("valley", 1, None, True, ["hill"], {"hill": 1})],
        *[("loads", value) for value in ([], 1.0, "1.0", None, {"a": 1.0}, ["a"], [True], [math.nan], [[1.0]])],
        *[("inner", value) for value in ([], "a: 1", 1, None)],
    ],
)
def test_a_value_of_the_wrong_type_is_refused_with_what_is_allowed(key, value):
    error = refusal({"length": 1.0} | {key: value})
    assert (error.file, error.key) == ("file.yaml", f"part.{key}")
    assert error.value is value
    assert KEYS[key].allowed in str(error)


@pytest.mark.parametrize("value", [10**20, 10**30])
def test_a_whole_number_beyond_the_machine_word_is_a_number(value):
    assert read({"length": value}, KEYS, "file.yaml")["length"] == float(value)


def test_a_whole_number_beyond_all_real_ones_is_refused():
    assert refusal({"length": 10**400}).key == "part.length"


@pytest.mark.parametrize("word", ["1e-6", "4.0e6", "4e6", "-1E-6", "5e+3", ".5e3", "2.5e-3 "])
def test_text_that_looks_like_a_number_is_refused_with_the_spelling_that_is_one(word):
    error = refusal({"length": word})
    assert_says(error, "file.yaml", "part.length", word, "text to YAML")
    spelling = yaml.safe_load(str(error).rpartition("exponent: ")[2].rstrip(")"))
    assert isinstance(spelling, float)
    assert spelling == float(word)


@pytest.mark.parametrize("word", ["inf", "nan", "-inf"])
def test_words_for_what_is_no_number_get_no_hint_how_to_spell_it(word):
    assert "exponent" not in str(refusal({"length": word}))


@pytest.mark.parametrize(
    ("key", "value", "hint"),
    [
        ("length", 1e101, "1e+100"),
        ("length", 10**400, "1e+100"),
        ("step", 1e-101, "1e-100"),
        ("points", 2**63, "at most 9223372036854775807"),
        ("loads", list(range(10_001)), "at most 10000 entries"),
        ("title", "x" * 5001, "at most 5000 characters"),
        ("title", "a\0b", "that can be printed"),
        ("title", "$a$", "$ at most once"),
    ],
)
def test_what_is_too_large_to_be_used_is_refused_with_the_limit(key, value, hint):
    assert hint in str(refusal({"length": 1.0} | {key: value}))


def test_an_entry_given_twice_in_a_list_is_refused_even_if_spelt_differently():
    for loads in ([1.0, 2.0, 1.0], [1, 1.0]):
        error = refusal({"length": 1.0, "loads": loads})
        assert_says(error, "file.yaml", "part.loads", loads, "a list of numbers", "an entry is given twice")


def test_a_list_keeps_its_order_and_converts_each_entry():
    assert read({"length": 1.0, "loads": [3, 1.5]}, KEYS, "file.yaml")["loads"] == [3.0, 1.5]


def test_a_long_value_is_cut_in_the_message():
    assert len(str(refusal({"length": "x" * 5000}))) < 300


@dataclass
class Hill:
    height: float
    steps: int
    name: str = "hill"
    slope: float | None = None
    path: str | None = None
    layers: list = field(default_factory=list)
    summit: float = field(default=1.0, init=False)


def test_keys_of_a_dataclass_are_the_fields_that_a_config_can_give():
    keys = keys_of(Hill)
    assert list(keys) == ["height", "steps", "name", "slope", "path"]
    values = read({"height": 1, "steps": 2}, keys, "f")
    assert values == {"height": 1.0, "steps": 2, "name": "hill", "slope": None, "path": None}


@pytest.mark.parametrize("bad", [{"height": "1.0"}, {"steps": 2.0}, {"name": 1}, {"slope": None}, {"path": None}])
def test_keys_of_a_dataclass_are_read_by_the_types_of_its_fields(bad):
    error = refusal({"height": 1.0, "steps": 1} | bad, keys_of(Hill))
    assert error.key == f"part.{next(iter(bad))}"


@pytest.mark.parametrize(
    ("base", "over", "result"),
    [
        ({"a": 1, "b": 2}, {"b": 3, "c": 4}, {"a": 1, "b": 3, "c": 4}),
        ({"a": {"b": 1, "c": {"d": 2}}}, {"a": {"c": {"e": 3}}}, {"a": {"b": 1, "c": {"d": 2, "e": 3}}}),
        ({"a": [1, 2, 3]}, {"a": [9]}, {"a": [9]}),
        ({"a": 8}, {"a": {"b": 1}}, {"a": {"b": 1}}),
        ({"a": {"b": 1}}, {"a": [1]}, {"a": [1]}),
        ({"a": 1, "b": {"c": 2, "d": 3}}, {"a": None, "b": {"c": None}, "e": None}, {"b": {"d": 3}, "e": None}),
    ],
)
def test_overlaying_merges_mappings_replaces_all_else_and_takes_out_what_is_null(base, over, result):
    before = deepcopy((base, over))
    assert overlaid(base, over) == result
    assert (base, over) == before


def test_an_error_stays_what_it_is_on_its_way_between_processes():
    error = pickle.loads(pickle.dumps(InputError("points", 3, "more", "file.yaml")))
    assert (error.key, error.value, error.allowed, error.file) == ("points", 3, "more", "file.yaml")
    assert str(error) == "file.yaml: points: got 3; allowed: more"
