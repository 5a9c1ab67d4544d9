"""Causes of verdicts that are not plainly "reproduced": their kinds, and their text in a table of verdicts.

The text of a cause names numbers in braces: those of its row, such as {value}, and others of the same data, which the
cause defines as `numbers`. They are put in when the row is made, so that no number of the data stands in the config.
"""

from __future__ import annotations

import math
import string
from collections.abc import Mapping
from dataclasses import dataclass, field

import pandas as pd

from contactsim.analysis.rounding import UNKNOWN as UNKNOWN_NUMBER
from contactsim.analysis.rounding import rounded_texts, short_number
from contactsim.analysis.verdict import CONDITION, DEPENDS, NOT_DECIDABLE, NOT_REPRODUCED

KINDS = (
    "physics",
    "grid of the thesis",
    "estimator",
    "choice of the thesis",
    "contradiction in the text",
    "our choice",
)
"""Kinds of causes."""
FAILING = (NOT_REPRODUCED, CONDITION, DEPENDS, NOT_DECIDABLE)
"""Verdicts that have a cause."""
UNKNOWN = "cause not yet known"
NUMBERS = {"": "value", "beside_": "beside_value", "condition_": "condition_value"}
"""Numbers that a text may name, by the start of the names of their errors."""
ROW_NUMBERS = tuple(
    name
    for prefix, value in NUMBERS.items()
    for name in (value, *(f"{prefix}{error}" for error in ("error", "ensemble_error", "grid_error")))
) + ("margin", "beside_margin")
"""Numbers of the row that a text may name; an `error` is that of ensemble and grid in quadrature."""
CELL_NUMBERS = ("cells_holding", "cells_failing", "cells_undecided", "cells_decided", "cells_admitted")
"""Numbers of candidates that a text may name."""
RULE_NUMBERS = ("cells_right", "side", "boundary")
"""What the text of a cause with `cell` may name too."""
PERCENT = "%"
"""Format of a number that is given in percent, with three digits."""


@dataclass(frozen=True)
class Cause:
    """Cause of a failure.

    Attributes
    ----------
    kind
        One of `KINDS`.
    text
        A short text with the numbers that show it; those of the row stand in braces.
    cell
        Measure of the cell that separates candidates in which the statement holds and fails: an exponent by length.
    numbers
        Further numbers of the data by name, each with the settings of a claim.
    """

    kind: str
    text: str
    cell: Mapping[str, float] | None = None
    numbers: Mapping[str, Mapping] = field(default_factory=dict)

    @property
    def named_numbers(self) -> list[tuple[str, str]]:
        """Names in braces, each with its format; ValueError for braces that do not match."""
        parts = string.Formatter().parse(self.text)
        return [(name, f"!{how}" if how else form or "") for _, name, form, how in parts if name is not None]

    @property
    def known_names(self) -> tuple[str, ...]:
        """Names that may stand in braces."""
        return (*ROW_NUMBERS, *self.numbers, *CELL_NUMBERS, *(RULE_NUMBERS if self.cell else ()))

    def filled(self, row: Mapping, cells: Mapping[str, str], numbers: Mapping[str, float]) -> str:
        """Return kind and text as one sentence, with the numbers of a row, of the candidates and its own put in."""
        texts = _row_texts(row) | {name: _number_texts(number) for name, number in numbers.items()}
        parts = {name: _Text(text) for name, text in texts.items()}
        parts |= {name: _Text({"": cells.get(name, UNKNOWN_NUMBER)}) for name in (*CELL_NUMBERS, *RULE_NUMBERS)}
        return f"{self.kind.capitalize()}: {' '.join(self.text.split())}".format(**parts)


class _Text(dict):
    """A number in texts by its formats: none, and in percent."""

    def __format__(self, form: str) -> str:
        """Return the text of a format."""
        return str(self[form])


def _row_texts(row: Mapping) -> dict[str, dict[str, str]]:
    """Return the numbers of a row that a text may name, as texts by format."""
    margins = ("margin", "beside_margin")
    texts: dict[str, dict[str, str]] = {name: {"": short_number(float(row[name]))} for name in margins}
    for prefix, value in NUMBERS.items():
        errors = [float(row[f"{prefix}{name}"]) for name in ("ensemble_error", "grid_error")]
        numbers = (float(row[value]), math.hypot(*errors), *errors)
        names = (value, *(f"{prefix}{name}" for name in ("error", "ensemble_error", "grid_error")))
        plain = [rounded_texts(numbers[0], *errors)[0], *(rounded_texts(error, error)[0] for error in numbers[1:])]
        for name, text, number in zip(names, plain, numbers, strict=True):
            texts[name] = {"": text, PERCENT: f"{100 * number:.3g} %"}
    return texts


def _number_texts(number: float) -> dict[str, str]:
    """Return a number that is not of the row as texts by format."""
    if math.isnan(number):
        return {"": UNKNOWN_NUMBER, PERCENT: UNKNOWN_NUMBER}
    return {"": _digits(number, 3), PERCENT: f"{_digits(100 * number, 2)} %"}


def _digits(number: float, digits: int) -> str:
    """Return a number with so many significant digits; a whole number with all of its own, and no decimals."""
    text = f"{number:#.{digits}g}".rstrip(".")
    return f"{number:.0f}" if "e+" in text or float(number).is_integer() else text


def cause_text(
    cause: Cause | None, row: Mapping, cells: Mapping[str, str], numbers: Mapping[str, float] | None = None
) -> str:
    """Return the cause as it is printed with a verdict: nothing with one that does not fail.

    Parameters
    ----------
    cause
        Cause of the config; None where it has none.
    row
        Row of the statement, with its verdict and numbers.
    cells
        Numbers of the candidates, of `contactsim.analysis.cell_rules.cell_texts`.
    numbers
        The numbers that the cause defines.
    """
    if row["verdict"] not in FAILING:
        return ""
    return UNKNOWN if cause is None else cause.filled(row, cells, numbers or {})


def claims_without_cause(claims: pd.DataFrame) -> list[str]:
    """Return the names of failing claims whose cause is not known; claims: table of verdicts."""
    causes = claims["cause"] if "cause" in claims else pd.Series("", claims.index)
    unknown = causes.fillna("").isin(["", UNKNOWN])
    return claims.claim[claims.verdict.isin(FAILING) & unknown].tolist()
