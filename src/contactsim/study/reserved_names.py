"""Names that a study cannot have: those of the workflow's rules and of the Makefile's targets."""

from __future__ import annotations

import re
from pathlib import Path

RULE = re.compile(r"^ *rule (\w+):", re.MULTILINE)
TARGET = re.compile(r"^(\w+):(?!=)", re.MULTILINE)
SOURCES = (("Snakefile", RULE), ("workflow/rules/*.smk", RULE), ("Makefile", TARGET))
"""Files of a project that name what can be made, and how they write it."""


def reserved_names(project: Path) -> tuple[str, ...]:
    """Return the names of the rules and targets of a project, sorted; its files are read as text."""
    texts = ((file.read_text(encoding="utf-8"), form) for files, form in SOURCES for file in project.glob(files))
    return tuple(sorted({name for text, form in texts for name in form.findall(text)}))
