"""Text about statements: names and symbols of quantities, readings, measures, ranges of loads and variants."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from contactsim import variables
from contactsim.analysis.carried import CARRIED
from contactsim.analysis.rounding import FORMULA, number_text, short_number

REDUCTION_PHRASES = {
    "kappa_fit": "κ of the fit to each H",
    "kappa_fit_logarithm": "κ of the logarithmic fit",
    "kappa_fit_all": "κ of the fit to all H",
    "spread_ratio": "ratio of spreads",
    "rise_gain": "gain of the rise",
    "least_rise_gain": "least gain of the rise",
    "largest_rise_gain": "largest gain of the rise",
}
"""Quantities and reductions of claims that no dataset holds."""
MEASURE_PHRASES = {
    "furthest_from_one": "value furthest from one",
    "largest_difference": "largest difference between any two",
    "largest_size": "largest size",
    "origin_slope": "slope through the origin",
    "ratio_size": "size of the ratio",
}
"""Reductions whose names are not read as words."""
STUDY_PHRASES = {
    "rough_line": "rough lines",
    "rough_line_many": "many rough lines",
    "rough_surface": "rough surfaces",
    "rough_surface_fine": "rough surfaces",
    "smooth_line": "cylinders",
    "smooth_surface": "spheres",
    "indentation": "adhesive cylinder",
    "indentation_close": "closer cylinders",
    "indentation_thick": "thicker layer",
    "indentation_uncoupled": "uncoupled law",
    "indentation_wide": "period twice as long",
    "pull_off": "other ν",
    "interplay": "coupled law",
    "interplay_uncoupled": "uncoupled law with friction",
    "interplay_close": "coupled law at a close spacing",
    "interplay_close_uncoupled": "uncoupled law with friction",
    "rough_adhesive": "adhesive rough lines",
    "rough_adhesive_15": "lines of 15 nm rms height",
    "rough_adhesive_30": "lines of 30 nm rms height",
    "rough_adhesive_hurst": "lines of smaller H",
    "rough_adhesive_64": "lines without waves below 1/64",
    "rough_adhesive_128": "lines without waves below 1/128",
    "rough_adhesive_many": "a hundred adhesive rough lines",
    "rough_adhesive_15_many": "a hundred lines of 15 nm rms height",
    "rough_adhesive_hurst_many": "a hundred lines of smaller H",
    "rough_adhesive_long_many": "a hundred lines without short waves",
    "rough_adhesive_coupled": "the coupled law",
    "rough_repulsive": "repulsion alone",
    "rough_onset": "first contact of adhesive rough lines",
    "rough_stiff": "weak adhesion on stiff repulsion",
    "rough_wall": "hard wall",
    "rough_attraction": "hard wall that attracts",
    "adhesive_surface": "adhesive rough surfaces",
    "adhesive_surface_wall": "surfaces at a hard wall",
    "adhesive_profile": "adhesive rough lines of the same spectrum",
    "probe": "high friction",
    "probe_weak": "half the work",
    "probe_low_friction": "low friction",
}
"""Studies that statements compare, in words."""
STUDIES = re.compile(r" in (\w+) (over|minus|beside) (\w+)")
"""Both studies in the measure of a claim."""
NAME = re.compile(r"[a-z]\w*")
"""A name of a quantity or a dimension, or a word, in the measure of a claim."""
CELL_SETS = {
    "admitted": ("admitted cell", "admitted cells"),
    "admitted_by_signs": ("that also has the signs of the text", "that also have the signs of the text"),
    "apart": ("that is apart from its replicas", "that are apart from their replicas"),
}
"""Sets of candidates in words: one cell, and several."""
MIN_SHARED = 5
"""Fewest cells whose share is given beside their number."""
INDEX_LETTERS = {
    "κ_r": "κᵣ",
    "p_r*": "pᵣ*",
    "κr": "κᵣ",
    "ḡr": "ḡᵣ",
    "φn": "φₙ",
    "φt": "φₜ",
    "δn": "δₙ",
    "δt": "δₜ",
    "σmax": "σₘₐₓ",
    "τmax": "τₘₐₓ",
}
"""Symbols of statements and captions as they are printed."""


def quantity_text(name: str) -> str:
    """Return a quantity's name as it is read in a sentence; an unknown word stays as it is."""
    errors = {f"_{kind}_error": f"{kind.replace('_', ' ')} error of " for kind in variables.ERRORS}
    for suffix, words in errors.items():
        if name.endswith(suffix):
            return words + quantity_text(name.removesuffix(suffix))
    if name in CARRIED:
        return f"{quantity_text(CARRIED[name])} carried to the thesis's grid"
    return REDUCTION_PHRASES.get(name) or variables.find_variable(name).phrase or name


def range_text(dim: str, low: float, high: float) -> str:
    """Return the range of a load or of a varied key in words, such as "p* from 0.001 to 0.01"."""
    variable = variables.find_variable(dim)
    unit = "" if variable.unit == "1" else f" {variable.unit}"
    values = f"= {low:g}{unit}" if low == high else f"from {low:g} to {high:g}{unit}"
    return f"{variable.phrase or dim.replace('_', ' ')} {values}"


def measure_text(measure: str) -> str:
    """Return the measure of a claim with symbols and words in place of the names of quantities and studies."""
    if measure.startswith(FORMULA):
        return FORMULA
    text = STUDIES.sub(lambda names: f" ({study_text(names[1])} {names[2]} {study_text(names[3])})", measure)
    reduction = text.partition(" ")[0]
    text = text.replace(reduction, MEASURE_PHRASES.get(reduction, reduction), 1)
    return NAME.sub(lambda name: quantity_text(name[0]).replace("_", " "), text)


def study_text(name: str) -> str:
    """Return a study in words; one without a phrase by its name."""
    return STUDY_PHRASES.get(name, name).replace("_", " ")


def beside_text(row: Mapping[str, Any]) -> str:
    """Return the second row of a claim, which is not counted: quantity, number, verdict and margin; or nothing."""
    name = row.get("beside")
    if not isinstance(name, str) or not name:
        return ""
    margin = row.get("beside_margin", np.nan)
    sure = "" if np.isnan(margin) else f" (margin {short_number(margin)})"
    return f"{quantity_text(name)} {number_text(row, 'beside_')}, {row['beside_verdict']}{sure}"


def extreme_text(row: Mapping[str, Any]) -> str:
    """Return where an extreme lies, and for which share of loads and variants the value is in the band; or nothing."""
    place = row.get("extreme_at")
    if not isinstance(place, str) or not place:
        return ""
    share = row.get("share_in_band", np.nan)
    return f"at {place}; {share:.0%} of all in the band" if share < 1 else f"at {place}"


def choices_text(row: Mapping[str, Any]) -> str:
    """Return with how many admissible readings and in how many cells a claim holds, and the verdict of the default."""
    texts = [readings_text(row), candidates_text(row)]
    texts = [text for text in texts if text]
    return "; ".join([*texts, f"as judged: {row['default_verdict']}"]) if texts else ""


def readings_text(row: Mapping[str, Any]) -> str:
    """Return with how many admissible readings a claim holds; nothing without other readings."""
    if not isinstance(row.get("choices"), str) or not row["choices"]:
        return ""
    count = int(row["choices_decided"])
    if not count:
        return "not decidable with any reading"
    holding = round(count * float(row["choices_share"]))
    part = _part_text("with", holding, count, "reading that is decided", "readings that are decided")
    return f"holds {part}"


def candidates_text(row: Mapping[str, Any]) -> str:
    """Return in how many of the decided admitted cells a claim holds, in all sets; nothing without any.

    The share and its binomial error follow where they are of `MIN_SHARED` cells or more.
    """
    texts = []
    for group, of_cells in CELL_SETS.items():
        count = row.get(f"{group}_decided", np.nan)
        if not count > 0:
            continue
        holding = round(count * row[f"{group}_share"])
        share = f" ({row[f'{group}_share']:.0%} ± {row[f'{group}_error']:.0%})" if count >= MIN_SHARED else ""
        texts.append(f"{_part_text('in', holding, int(count), *of_cells)}{share}")
    return f"holds {', and '.join(texts)}" if texts else ""


def _part_text(word: str, holding: int, count: int, singular: str, plural: str) -> str:
    """Return a part of several things in words, such as "in 36 of the 38 admitted cells"."""
    if count == 1:
        return f"{'' if holding else 'not '}{word} the one {singular}"
    part = "all" if holding == count else str(holding or "none")
    return f"{word} {part} of the {count} {plural}"


def printed(text: str) -> str:
    """Return a statement or a caption with its symbols as they are printed."""
    for plain, letters in INDEX_LETTERS.items():
        text = text.replace(plain, letters)
    return text
