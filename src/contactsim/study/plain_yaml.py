"""Plain YAML: the text of a settings file becomes a mapping, or an error with the line.

Only mappings, lists, text, decimal numbers, true, false and null are read. What YAML 1.1 knows beyond them is text, so
that no value changes its meaning unseen: `no` and `2019-01-01` are text, and so are `0x10`, `017` and `12:30`. Keys are
text, and stand once. Tags are refused. Depth and number of values are bounded, those that aliases repeat included.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

import yaml

from contactsim.errors import InputError, Words

MAX_BYTES, MAX_DEPTH, MAX_VALUES = 4_000_000, 50, 100_000
"""Largest file, deepest nesting, and most values of a file, with those that aliases repeat."""
READABLE = "a file that can be read, of at most 4 MB"
FORM = "plain YAML, each key once"
NO_TEXT = {
    "null": (r"~|null|Null|NULL|", ["~", "n", "N", ""]),
    "bool": (r"true|True|TRUE|false|False|FALSE", list("tTfF")),
    "int": (r"[-+]?(?:0|[1-9][0-9]{0,99})", list("-+0123456789")),
    "float": (r"[-+]?(?:[0-9]+\.[0-9]*|\.[0-9]+)(?:[eE][-+][0-9]+)?", list("-+.0123456789")),
    "merge": (r"<<", ["<"]),
}
"""Plain words that are no text: the form of each kind, and the letters with which it may begin."""
NO_KEY = re.compile("|".join(f"(?:{form})" for kind, (form, _) in NO_TEXT.items() if kind != "merge"))
"""Plain words that are no text, and no mark of a merge."""


class SettingsLoader(getattr(yaml, "CSafeLoader", yaml.SafeLoader)):  # type: ignore[misc]  # in C where that is installed
    """Safe YAML, read in C where that is installed, without the words that only YAML 1.1 takes for numbers or truth."""

    yaml_implicit_resolvers: dict = {}


for _kind, (_form, _first) in NO_TEXT.items():
    SettingsLoader.add_implicit_resolver(f"tag:yaml.org,2002:{_kind}", re.compile(f"(?:{_form})$"), _first)


def load_yaml(path: str | Path) -> dict:
    """Return the mapping in a YAML file.

    Raises
    ------
    InputError
        For a file that cannot be read, and for what is no plain YAML, with the line as it is typed.
    """
    text = read_text(Path(path))
    try:
        _check_structure(text)
        content = yaml.load(text, SettingsLoader)
    except yaml.YAMLError as error:
        raise _located(error, text, path) from error
    if content is None:
        return {}
    if not isinstance(content, dict):
        raise InputError("top level", content, "a mapping of keys to values", path)
    return content


def read_text(path: Path) -> str:
    """Return the text of a file; InputError for what is no file, too large or not UTF-8."""
    try:
        if not path.is_file() or path.stat().st_size > MAX_BYTES:
            raise InputError("file", path, READABLE, path)
        content = path.read_bytes()
    except OSError as error:
        raise InputError("file", path, READABLE, path) from error
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start)
        typed = content.split(b"\n")[line].decode("utf-8", "backslashreplace").strip()
        raise InputError(f"line {line + 1}", Words(typed), "text in UTF-8", path) from error


@dataclass
class _Part:
    """A list or a mapping that is being read: its anchor, the values before it, and its keys where it has any."""

    anchor: str | None
    before: int
    is_mapping: bool
    entries: int = 0
    keys: set[str] = field(default_factory=set)

    def problem(self, entry: yaml.Event) -> str:
        """Count an entry; return what is wrong with it as a key, nothing where it is none."""
        self.entries += 1
        if not self.is_mapping or self.entries % 2 == 0:
            return ""
        if not isinstance(entry, yaml.ScalarEvent) or (entry.implicit[0] and NO_KEY.fullmatch(entry.value)):
            return "a key that is no text"
        if entry.value in self.keys:
            return f"key {entry.value!r} is given twice"
        self.keys.add(entry.value)
        return ""


def _check_structure(text: str) -> None:
    """Raise a YAML error for values that are nested too deep, too many, tagged or part of themselves, and for keys."""
    sizes: dict[str, int] = {}
    parts: list[_Part] = []
    count = 0
    for event in yaml.parse(text, SettingsLoader):
        problem = ""
        if isinstance(event, yaml.NodeEvent):
            problem = parts[-1].problem(event) if parts else ""
            count += sizes.get(event.anchor, 1) if isinstance(event, yaml.AliasEvent) else 1
            if isinstance(event, yaml.AliasEvent) and event.anchor in [part.anchor for part in parts]:
                problem = "an alias of what it is part of"
            elif getattr(event, "tag", None) is not None:
                problem = "a tag"
        if isinstance(event, yaml.CollectionStartEvent):
            parts.append(_Part(event.anchor, count - 1, isinstance(event, yaml.MappingStartEvent)))
            problem = problem or f"more than {MAX_DEPTH} levels" * (len(parts) > MAX_DEPTH)
        elif isinstance(event, yaml.CollectionEndEvent):
            part = parts.pop()
            sizes |= {part.anchor: count - part.before} if part.anchor is not None else {}
        problem = problem or f"more than {MAX_VALUES} values, with those that aliases repeat" * (count > MAX_VALUES)
        if problem:
            raise yaml.MarkedYAMLError(problem=problem, problem_mark=event.start_mark)


def _located(error: yaml.YAMLError, text: str, path: str | Path) -> InputError:
    """Return the error of a text that is no plain YAML, with the line as it is typed."""
    mark = getattr(error, "problem_mark", None) or getattr(error, "context_mark", None)
    line = text.count("\n", 0, getattr(error, "position", 0)) if mark is None else mark.line
    parts = (getattr(error, name, None) for name in ("context", "problem", "reason"))
    reason = " ".join(" ".join(part for part in parts if part).split())
    typed = "".join(text.split("\n")[line : line + 1]).strip()
    return InputError(f"line {line + 1}", Words(typed), f"{FORM} ({reason})", path)
