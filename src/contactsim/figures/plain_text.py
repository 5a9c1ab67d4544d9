"""Labels of figures as plain text, for pages that do not typeset mathematics."""

from __future__ import annotations

import re
import unicodedata

ACCENTS = {"bar": "\u0304", "hat": "\u0302", "dot": "\u0307", "tilde": "\u0303"}
"""Combining characters of the accents."""
SIGNS = {
    "langle": "⟨",
    "rangle": "⟩",
    "cdot": "·",
    "times": "×",
    "leq": "≤",
    "geq": "≥",
    "le": "≤",
    "ge": "≥",
    "approx": "≈",
    "pm": "±",
    "infty": "∞",
    "to": "→",
    "varphi": "φ",
    "varepsilon": "ε",
    "ln": "ln ",
    "log": "log ",
    "sqrt": "√",
}
"""Commands and the characters that they stand for; Greek letters are found by their names."""


def plain_text(label: str) -> str:
    """Return a label as plain text: formulas between dollar signs become characters, as far as there are any.

    Indices and powers stay between braces, as in κ_{r} and a^{2}.
    """
    parts = label.split("$")
    text = "".join(_plain_formula(part) if index % 2 else part for index, part in enumerate(parts))
    return unicodedata.normalize("NFC", text.strip())


def _plain_formula(formula: str) -> str:
    """Return a formula as characters."""
    text = re.sub(r"\\(?:left|right|,|;|!|\s)", "", formula)
    text = re.sub(r"\\(?:mathrm|mathit|mathbf|text)\s*\{([^{}]*)\}", r"\1", text)
    text = re.sub(r"\\([A-Za-z]+)\s?", lambda found: _character(found[1]), text)
    text = re.sub(rf"([{''.join(ACCENTS.values())}])\s*\{{?(\w)\}}?", r"\2\1", text)
    text = re.sub(r"([_^])([^{\s])", r"\1{\2}", text)
    return re.sub(r"(?<![_^])\{([^{}]*)\}", r"\1", text).replace("^{*}", "*").replace("-", "−")


def _character(command: str) -> str:
    """Return the character of a command."""
    if command in SIGNS | ACCENTS:
        return (SIGNS | ACCENTS)[command]
    size = "CAPITAL" if command[0].isupper() else "SMALL"
    try:
        return unicodedata.lookup(f"GREEK {size} LETTER {command.upper().replace('LAMBDA', 'LAMDA')}")
    except KeyError:
        return command
