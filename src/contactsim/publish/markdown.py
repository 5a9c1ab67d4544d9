"""Markdown of words that settings hold: they stand as they are, and are no HTML, no link and no line of their own."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

ACTIVE = str.maketrans({"&": "&amp;", "<": "&lt;", "[": "\\["})
"""Signs that begin HTML or a link."""


def plain_words(text: str) -> str:
    """Return words for a page, on one line."""
    return " ".join(text.split()).translate(ACTIVE)


def table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table; its cells are Markdown, and words of settings in them have gone through `plain_words`."""
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n".join("| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines) + "\n"
