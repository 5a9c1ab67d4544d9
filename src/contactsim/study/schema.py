"""JSON Schema of a chapter's settings: with it an editor completes keys, explains them and marks unknown ones.

It is made from the tables by which settings are read. What a value may be is said in words there, so the schema checks
keys and kinds; the workflow checks the values.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from contactsim.interface.registry import EFFECTS
from contactsim.study.chapter import CHAPTER_KEYS
from contactsim.study.claim_keys import CLAIM_KEYS
from contactsim.study.figure_plan import FIGURE_KEYS, FILM_KEYS
from contactsim.study.keys import (
    BODIES,
    ERROR_RUNS,
    MODULI,
    PATH_KEYS,
    SECTION_KINDS,
    SLIDE_KEYS,
    STUDY_KEYS,
)
from contactsim.study.reading import REQUIRED, Key, keys_of

DIALECT = "https://json-schema.org/draft/2020-12/schema"


def chapter_schema() -> dict[str, Any]:
    """Return the schema of a file config/ch*.yaml."""
    figure = _mapping(FIGURE_KEYS, film=_mapping(FILM_KEYS))
    sections = {"studies": _study(), "figures": figure, "claims": _mapping(CLAIM_KEYS)}
    sections["findings"] = sections["claims"]
    properties = {name: {"additionalProperties": sections[name], "type": "object"} for name in CHAPTER_KEYS}
    return {"$schema": DIALECT, "title": "Chapter", "type": "object", "properties": properties} | {
        "additionalProperties": False
    }


def _mapping(keys: Mapping[str, Key], **more: Any) -> dict[str, Any]:
    """Return the schema of a mapping with these keys, of which none is unknown; more: schemas of some of them."""
    known = {name: _value(key) | more.get(name, {}) for name, key in keys.items()}
    schema = {"type": "object", "properties": known, "additionalProperties": False}
    required = [name for name, key in keys.items() if key.default is REQUIRED]
    return schema | ({"required": required} if required else {})


def _value(key: Key) -> dict[str, Any]:
    """Return what is known of a value: what is allowed in words, and the default."""
    default = {} if key.default is REQUIRED or key.default is None else {"default": key.default}
    return {"description": key.allowed} | default


def _study() -> dict[str, Any]:
    """Return the schema of a study."""
    more = {name: _section(name) for name in SECTION_KINDS}
    more |= {"path": _mapping(PATH_KEYS), "slide": _mapping(SLIDE_KEYS)}
    more |= {name: _mapping(keys) for name, (_, _, keys) in ERROR_RUNS.items()}
    more |= {name: _mapping(keys_of(EFFECTS[name])) for name in EFFECTS if name in STUDY_KEYS}
    return _mapping(STUDY_KEYS, **more)


def _section(name: str) -> dict[str, Any]:
    """Return the schema of a section whose kind decides which keys it has."""
    kinds, class_of = SECTION_KINDS[name]
    branches = []
    for kind in kinds:
        keys = dict(keys_of(class_of(kind)))
        if name in BODIES and "contact_modulus" in keys:
            keys |= MODULI
        branch = _mapping(keys)
        branch["properties"]["kind"] = {"const": kind}
        branches.append({"if": {"properties": {"kind": {"const": kind}}, "required": ["kind"]}, "then": branch})
    return {"type": "object", "properties": {"kind": {"enum": list(kinds)}}, "allOf": branches}
