"""A settings file is plain YAML, or refused at once with its line as it is typed."""

from __future__ import annotations

import os
import time

import pytest

from contactsim.errors import InputError
from contactsim.study.plain_yaml import MAX_DEPTH, load_yaml


@pytest.fixture
def written(tmp_path):
    """Write text or bytes into a YAML file."""

    def write(content):
        path = tmp_path / "file.yaml"
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    return write


def refusal(path):
    """The error of a file, which comes within a second of CPU time."""
    start = time.process_time()
    with pytest.raises(InputError) as caught:
        load_yaml(path)
    assert time.process_time() - start < 1.0
    error = caught.value
    assert error.file == path
    assert "\n" not in str(error)
    assert len(str(error)) < 500
    return error


def test_a_file_is_read_as_a_mapping_in_utf_8(written):
    assert load_yaml(written("a: {b: 1.0e-3}\nc: κ\n")) == {"a": {"b": 1e-3}, "c": "κ"}
    assert load_yaml(written("a: 1\r\nb: [x]\r\n".encode("utf-8-sig"))) == {"a": 1, "b": ["x"]}


def test_an_empty_file_is_an_empty_mapping(written):
    assert load_yaml(written("# nothing\n")) == {}


def test_aliases_and_merged_keys_stand_for_what_they_name(written):
    merged = load_yaml(written("a: &a {x: 1, y: 2}\nb: &b {<<: *a, x: 3}\nc: {<<: *b, y: *a}\n"))
    assert merged["c"] == {"x": 3, "y": {"x": 1, "y": 2}}
    assert load_yaml(written("top: {in: &a {<<: {x: 1}, x: 2}}\nb: {<<: *a}\n"))["b"] == {"x": 2}


@pytest.mark.parametrize(
    ("typed", "value"),
    [
        *[(word, word) for word in ("no", "yes", "on", "0x10", "0o17", "017", "1_000", "12:30", "2019-01-01", "1e3")],
        *[(word, word) for word in (".inf", ".nan", "=", "9" * 101)],
        *[("-5", -5), ("+5", 5), ("0", 0), ("1.", 1.0), (".5", 0.5), ("-1.5e+3", -1500.0), ("9" * 100, int("9" * 100))],
        *[("true", True), ("False", False), ("null", None), ("~", None), ("", None)],
    ],
)
def test_a_plain_word_means_what_it_looks_like(written, typed, value):
    read = load_yaml(written(f"x: {typed}\n"))["x"]
    assert read == value
    assert type(read) is type(value)


def test_what_is_no_file_is_named(tmp_path):
    link, pipe, large = tmp_path / "link.yaml", tmp_path / "pipe.yaml", tmp_path / "large.yaml"
    link.symlink_to(tmp_path / "nowhere")
    os.mkfifo(pipe)
    large.write_text("# " + "x" * 5_000_000)
    for path in (tmp_path / "nowhere.yaml", tmp_path, link, pipe, large):
        error = refusal(path)
        assert (error.key, error.value) == ("file", path)
        assert "a file that can be read" in str(error)


@pytest.mark.parametrize(("content", "value"), [("[1, 2]", [1, 2]), ("5", 5), ("text", "text")])
def test_a_file_that_is_no_mapping_is_refused(written, content, value):
    error = refusal(written(content))
    assert (error.key, error.value) == ("top level", value)
    assert "a mapping of keys to values" in str(error)


@pytest.mark.parametrize(
    ("content", "line", "typed", "reason"),
    [
        ("a: 1\nb: 2\na: 3\n", 3, "a: 3", "key 'a' is given twice"),
        ("top:\n  a: {c: 1}\n  a: {d: 2}\n", 3, "a: {d: 2}", "given twice"),
        ("list:\n- {x: 1, x: 1}\n", 2, "- {x: 1, x: 1}", "given twice"),
        ("a: 1\n12: 3\n", 2, "12: 3", "a key that is no text"),
        ("null: 3\n", 1, "null: 3", "no text"),
        ("? [1, 2]\n: 3\n", 1, "? [1, 2]", "no text"),
        ("a: [1, 2\n", 2, "", "expected"),
        ("a: 1\n b: 2\n", 2, "b: 2", "mapping values are not allowed"),
        ("a: 1\n\tx: 1\n", 2, "x: 1", "tab character"),
        ("a: 1\nb: \x07\n", 2, r"b: \x07", "control characters"),
        ("a: \0\n", 1, r"a: \x00", "control characters"),
        ("a: 1\n---\nb: 2\n", 2, "---", "another document"),
        ("a: *b\n", 1, "a: *b", "undefined alias"),
        ("a: {<<: 3}\n", 1, "a: {<<: 3}", "mapping"),
        ("a: &a [*a]\n", 1, "a: &a [*a]", "an alias of what it is part of"),
        ("a: &a {<<: *a}\n", 1, "a: &a {<<: *a}", "an alias of what it is part of"),
        *[
            (f"a: 1\nb: {tag} x\n", 2, f"b: {tag} x", "a tag")
            for tag in ("!!python/name:os.system", "!!python/object/apply:os.system", "!!binary", "!!timestamp")
        ],
        *[(f"b: {tag} x\n", 1, f"b: {tag} x", "a tag") for tag in ("!!bool", "!!int", "!!str", "!own", "!")],
    ],
)
def test_what_is_no_plain_yaml_is_refused_with_the_line_as_it_is_typed(written, content, line, typed, reason):
    error = refusal(written(content))
    assert error.key == f"line {line}"
    assert repr(error.value) == typed
    assert f"got {typed}; allowed: plain YAML, each key once" in str(error)
    assert reason in str(error)


def test_another_encoding_is_refused_with_the_line(written):
    error = refusal(written(b"a: 1\ntitle: \xb5m\n"))
    assert (error.key, str(error.value)) == ("line 2", r"title: \xb5m")
    assert "UTF-8" in str(error)
    refusal(written("a: 1\n".encode("utf-16")))


BOMB = "a0: &a0 [x, x, x, x, x, x, x, x, x]\n" + "".join(
    f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 9)}]\n" for n in range(1, 30)
)


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        ("a: " + "[" * 2000 + "]" * 2000, f"more than {MAX_DEPTH} levels"),
        ("a: " + "[" * 100_000 + "]" * 100_000, "levels"),
        ("a: " + "{a: " * 2000 + "1" + "}" * 2000, "levels"),
        ("".join(f"{' ' * n}a:\n" for n in range(1000)), "levels"),
        (BOMB, "more than 100000 values, with those that aliases repeat"),
        (BOMB.replace("[x, x, x, x, x, x, x, x, x]", "{x: 1}").replace("[", "{<<: [").replace("]", "]}"), "values"),
        ("a: [" + "1, " * 200_000 + "]", "values"),
        ("".join(f"k{n}: {n}\n" for n in range(60_000)), "values"),
    ],
    ids=["lists", "a hundred thousand lists", "mappings", "blocks", "aliases", "merged keys", "a long list", "keys"],
)
def test_what_would_take_all_memory_is_refused_at_once(written, content, reason):
    assert reason in str(refusal(written(content)))
