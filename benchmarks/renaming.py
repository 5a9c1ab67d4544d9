"""The table of names that changed between two trees."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

import yaml

DERIVED = r"(?:_(?:mean|standard_error|half_width|limit|order|spread|change|difference|members|\w*error)\w*)?"
"""What aggregation may add to the name of a variable."""


@dataclass(frozen=True)
class Renaming:
    """Old to new names, and what may differ.

    variables: of datasets, columns and keys; values: texts that are names; files: beginnings of paths; texts, digests,
    times: new names of variables, columns, keys and attributes that may differ; added, removed: the reason for each new
    name that only one tree has.
    """

    variables: dict[str, str] = field(default_factory=dict)
    values: dict[str, str] = field(default_factory=dict)
    files: dict[str, str] = field(default_factory=dict)
    texts: tuple[str, ...] = ()
    digests: tuple[str, ...] = ()
    times: tuple[str, ...] = ()
    added: dict[str, str] = field(default_factory=dict)
    removed: dict[str, str] = field(default_factory=dict)

    @classmethod
    def read(cls, path: Path) -> Renaming:
        """Read the table; a section that is empty may be left out."""
        return cls(**{name: part for name, part in yaml.safe_load(path.read_text(encoding="utf-8")).items() if part})

    def name(self, old: str) -> str:
        """Return the new name of a variable; what aggregation added to it stays."""
        for part in sorted(self.variables, key=len, reverse=True):
            if match := re.fullmatch(f"{re.escape(part)}({DERIVED})", old):
                return self.variables[part] + match[1]
        return old

    def value(self, old: str) -> str:
        """Return a text of the old tree as the new tree has it: a name by the table, anything else as it is."""
        return self.values.get(old) or self.name(old)

    def path(self, old: str) -> str:
        """Return the place of a file in the new tree."""
        for part in sorted(self.files, key=len, reverse=True):
            if old.startswith(part):
                return self.files[part] + old.removeprefix(part)
        return old

    def reason(self, name: str) -> str | None:
        """Return why a variable, column, key or attribute may differ, None if it may not."""
        kinds = {"text": self.texts, "digest": self.digests, "time": self.times}
        return next((kind for kind, names in kinds.items() if name in names), None)
