"""Numbers as texts: rounded to their error, with words for errors that do not exist or are not known."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from contactsim.analysis.reductions import ORDERS

ZERO = 1e-12
"""Size below which a number is zero but for rounding."""
SMALL = 1e-6
"""Numbers below it are written with a power of ten."""
ERROR_DIGITS, EXACT_DIGITS, MAX_DIGITS = 2, 4, 5
"""Significant digits of the total error, of a number without an error, and the most of any number."""
LARGE = 99
"""Numbers of errors, and places in a band, above it are not told apart."""
NONE, UNKNOWN, EXACT, ABSENT = "none", "not known", "exact", "–"
"""Words for an error that does not exist and for one that nobody knows, for a formula, and for an empty cell."""
NUMBERS = ("value", "ensemble_error", "grid_error")
"""Entries of a row with a number and its errors."""
FORMULA = "exact number"
"""Start of the measure of a statement that an equation answers."""


def rounded_texts(value: float, *errors: float) -> list[str]:
    """Return a value and its errors as texts, rounded to two digits of the total error.

    The value has five significant digits at most, and four without an error, but for a whole number. An error that is
    smaller than the last of them is given as a bound.
    """
    total = math.hypot(*(error for error in errors if math.isfinite(error)))
    size = max(abs(value), total) if math.isfinite(value) else total
    if size < ZERO:
        return [_number(number, 0) for number in (value, *errors)]
    if total < ZERO and float(value).is_integer():
        return [f"{value:.0f}", *(_number(error, 0) for error in errors)]
    if size < SMALL:
        return [UNKNOWN if math.isnan(number) else _power(number) for number in (value, *errors)]
    wanted = _decimals(total, ERROR_DIGITS) if total >= ZERO else _decimals(size, EXACT_DIGITS)
    decimals = min(wanted, _decimals(size, MAX_DIGITS))
    return [_number(value, decimals), *(_error(error, decimals) for error in errors)]


def _decimals(size: float, digits: int) -> int:
    """Return the number of decimals that show so many significant digits."""
    return max(0, digits - 1 - int(f"{size:.{digits - 1}e}".split("e")[1]))


def _number(value: float, decimals: int) -> str:
    """Return a number with so many decimals."""
    if not math.isfinite(value):
        return UNKNOWN if math.isnan(value) else f"{value:g}"
    return "0" if abs(value) < ZERO else f"{value:.{decimals}f}"


def _error(error: float, decimals: int) -> str:
    """Return an error with so many decimals; one that they do not show as less than the last of them."""
    text = _number(error, decimals)
    return f"< {10.0**-decimals:.{decimals}f}" if error >= ZERO and float(text) == 0 else text


def _power(value: float) -> str:
    """Return a small number with a power of ten."""
    return "0" if abs(value) < ZERO else f"{value:.1e}".replace("e-0", "e-")


def is_order(row: Mapping[str, Any]) -> bool:
    """Return True for a row about an order: its number is the worst step in errors, and has none itself."""
    return str(row.get("measure")).partition(" ")[0] in ORDERS


def number_cells(row: Mapping[str, Any], prefix: str = "") -> list[str]:
    """Return the number of a row, its ensemble error and its grid error as texts.

    Parameters
    ----------
    row
        Row of a table of verdicts.
    prefix
        Start of the entries: none for the number that counts, "beside_" and "condition_" for others.
    """
    value, *errors = (float(row[f"{prefix}{name}"]) for name in NUMBERS)
    if is_order(row):
        return [_step_text(value), "", ""]
    if str(row.get("measure")).startswith(FORMULA):
        return [rounded_texts(value)[0], EXACT, EXACT]
    if math.isnan(value):
        return [UNKNOWN, "", ""]
    texts = rounded_texts(value, *errors)
    return [texts[0], *(NONE if error == 0 else text for error, text in zip(errors, texts[1:], strict=True))]


def number_text(row: Mapping[str, Any], prefix: str = "") -> str:
    """Return the number of a row with both errors in one text; parameters as in `number_cells`."""
    value, *errors = number_cells(row, prefix)
    return f"{value} (exact)" if EXACT in errors else " ± ".join(text for text in (value, *errors) if text)


def _step_text(value: float) -> str:
    """Return the worst step of an order in errors."""
    if math.isnan(value):
        return UNKNOWN
    if abs(value) > LARGE:
        return f"worst step {'>' if value > 0 else '< -'}{' ' * (value > 0)}{LARGE} errors"
    return f"worst step {short_number(value)} errors"


def short_number(value: float) -> str:
    """Return a margin or a place in two digits: large ones only as large, zero below 0.005, and a dash for none."""
    if math.isnan(value):
        return ABSENT
    if abs(value) < 0.005:
        return "0"
    return f"> {LARGE}" if value > LARGE else f"< -{LARGE}" if value < -LARGE else f"{value:.2g}"
