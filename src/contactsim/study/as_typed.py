"""The value of a wrong setting as it is typed in its file, with the line: 1.0e-3, not 0.001."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

import yaml

from contactsim.errors import InputError, Words
from contactsim.study.plain_yaml import SettingsLoader, read_text
from contactsim.study.tier_overrides import TieredFile


def as_typed(error: InputError) -> InputError:
    """Return an error with its value as it is typed, and its line; as it is where the value stands in no file."""
    for path, keys in _places(error):
        try:
            text = read_text(path)
            loader = SettingsLoader(text)
            node = _find_value(loader, _find_key(loader, loader.get_single_node(), keys), error.value)
        except (ValueError, yaml.YAMLError):
            continue
        if node is not None:
            typed = " ".join(text[node.start_mark.index : node.end_mark.index].split())
            other = f" of {path}" if isinstance(error.file, TieredFile) else ""
            file = f"{error.file}, line {node.start_mark.line + 1}{other}"
            return InputError(error.key, Words(typed), error.allowed, file)
    return error


def _places(error: InputError) -> Iterable[tuple[Path, str]]:
    """Yield the files in which a setting may stand, each with its dotted key there."""
    if isinstance(error.value, Words):
        return
    varied = re.sub(r"^studies\.\w+\.", r"\g<0>vary.", error.key)
    for key in dict.fromkeys((error.key, varied)):
        if isinstance(error.file, TieredFile):
            file, tier = error.file, error.file.tier
            yield from ((file.tiers, f"{section}.{key}") for section in (tier, f"{tier}.{file.file.stem}"))
            yield file.file, key
        elif isinstance(error.file, str | Path):
            yield Path(error.file), key


def _find_key(loader: SettingsLoader, node: yaml.Node | None, key: str) -> yaml.Node | None:
    """Return the value of a dotted key below a node, where names may have dots too; None where there is none."""
    if not key:
        return node
    if isinstance(node, yaml.MappingNode):
        loader.flatten_mapping(node)
        entries = [(name.value, value) for name, value in reversed(node.value)]
    else:
        values = node.value if isinstance(node, yaml.SequenceNode) else []
        entries = [(str(place), value) for place, value in enumerate(values)]
    for name, value in entries:
        rest = key.removeprefix(name) if key.startswith(name) else "-"
        found = _find_key(loader, value, rest[1:]) if rest[:1] in ("", ".") else None
        if found is not None:
            return found
    return None


def _find_value(loader: SettingsLoader, node: yaml.Node | None, value: object) -> yaml.Node | None:
    """Return the node that is a value: the one given, or an entry of it."""
    entries = node.value if isinstance(node, yaml.SequenceNode) else []
    for entry in [node, *entries] if node is not None else []:
        if loader.construct_object(entry, deep=True) == value:
            return entry
    return None
