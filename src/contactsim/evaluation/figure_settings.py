"""Title, caption and size: the settings that all figures of the evaluation share."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

from contactsim.study.reading import Key, size, text

FIGURE_KEYS = {
    "title": Key(text, "a line of text"),
    "caption": Key(text, "text"),
    "size": Key(size, "width and height in inches"),
}


@dataclass(frozen=True)
class FigureSettings:
    """Settings of a figure; those of what the figure shows follow in subclasses, in the order of their file's keys.

    Parameters
    ----------
    title, caption : str
        Words beside the figure.
    size : sequence of float
        Width and height, inches.
    """

    title: str
    caption: str
    size: Sequence[float]

    @property
    def settings(self) -> dict[str, Any]:
        """All settings as they are written to JSON, in the order of the fields."""
        return asdict(self)

    @property
    def layout(self) -> dict[str, Any]:
        """Title, caption and size as they are written to JSON."""
        return {"title": self.title, "caption": self.caption, "size": self.size}
