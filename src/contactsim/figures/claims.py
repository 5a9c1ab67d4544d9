"""The verdicts of a chapter as files: CSV, and a table drawn with wrapped text and coloured verdicts."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.figure import Figure

from contactsim import dataset, ensemble
from contactsim.claims import CONDITION, NOT_DECIDABLE, NOT_REPRODUCED, REPRODUCED, verdicts
from contactsim.figures import style
from contactsim.figures.render import LINE_INCHES, save
from contactsim.takes import LIMIT

COLOURS = {REPRODUCED: "#cfe8d5", CONDITION: "#e9efc4", NOT_REPRODUCED: "#f3cfcb", NOT_DECIDABLE: "#e4e4e4"}
COLUMNS = {
    "source": ("thesis", 1.3),
    "statement": ("statement", 2.6),
    "measure": ("what is compared", 1.65),
    "expected": ("expected", 0.85),
    "value": ("found", 0.65),
    "ensemble_error": ("ensemble\nerror", 0.75),
    "grid_error": ("grid\nerror", 0.65),
    "verdict": ("verdict; on a condition: found\n± ensemble error ± grid error", 1.85),
    "because": ("why this band", 2.85),
}
"""Head and width in inches of each column."""
SYMBOLS = {
    "relative_contact_area": "aᵣₑₗ",
    "relative_contact_area_subgrid": "aᵣₑₗ with edges between points",
    "kappa": "κ",
    "kappa_r": "κᵣ",
    "kappa_r_bond": "κᵣ of pairs",
    "rms_gradient_contact": "ḡᵣ",
    "rms_gradient_contact_bond": "ḡᵣ of pairs",
    "rms_gradient_exact": "the exact ḡᵣ",
    "reduced_pressure": "p*",
    "reduced_pressure_contact": "pᵣ*",
    "mean_pressure": "p",
    "mean_gap": "the mean gap",
    "contact_ratio": "c/R",
    "contact_radius": "c",
    "contact_radius_exact": "the exact c",
    "half_width": "c",
    "half_width_exact": "the exact c",
    "hurst": "H",
    "poisson_ratio": "ν",
    "thickness": "the thickness",
    "kappa_fit": "κ of the fit to each H",
    "kappa_fit_logarithm": "κ of the logarithmic fit",
    "kappa_fit_all": "κ of the fit to all H",
    "nonlinearity": "the non-linearity",
    "nonlinearity_reduced": "the non-linearity in pᵣ*",
    "curvature": "the curvature",
    "curvature_reduced": "the curvature in pᵣ*",
    "pressure_at_fiftieth": "p/E* at aᵣₑₗ = 0.02",
    "pressure_at_tenth": "p/E* at aᵣₑₗ = 0.1",
    "pressure_at_third": "p/E* at aᵣₑₗ = 1/3",
    "dissipated_energy": "energy of a cycle",
    "dissipated_work": "energy of a cycle by area",
    "area_at_twelve": "aᵣₑₗ at 12 nm",
    "pressure_at_twelve": "p/E* at 12 nm",
    "gradient_at_fiftieth": "ḡᵣ/ḡ at aᵣₑₗ = 0.02",
    "surface_rms_height": "hᵣₘₛ",
    "least_step": "least step",
    "largest_step": "largest step",
    "spread_ratio": "ratio of spreads",
    "largest_spread": "largest spread",
    "least_rise": "least rise",
    "largest_rise": "largest rise",
    "rise_gain": "gain of the rise",
    "work_of_separation": "φn",
    "work_ratio": "φt/φn",
    "pull_off_load_loading": "the pull-off load",
    "pull_off_load_unloading": "the pull-off load on unloading",
    "pull_off_approach_loading": "the approach at pull-off",
    "pull_off_approach_unloading": "the approach at pull-off on unloading",
    "largest_jump_loading": "the largest jump on loading",
    "largest_jump_unloading": "the largest jump on unloading",
    "final_repulsive_length": "the contact size",
    "final_interacting_length": "the interacting length",
    "final_load": "the load",
    "final_repulsive_load": "the repulsive force",
    "final_adhesive_load": "the adhesive force",
    "final_pressure": "the largest pressure",
    "final_pull": "the largest pull",
    "final_slip": "the largest slip",
    "static_friction": "Fₛ",
    "mean_friction": "(Fₛ+Fₖ)/2",
    "average_friction": "the mean force",
    "onset_slide": "Uₓ at the onset",
    "onset_repulsive_length": "Aₛ",
    "initial_repulsive_length": "A₀",
    "initial_load": "L before the slide",
    "asymmetry_early": "asymmetry half way to the onset",
    "quadratic_coefficient": "ζ",
    "quadratic_agreement": "R² of Eq. 6.8",
    "first_drop": "the first drop",
    "first_periods": "cells of the first slip",
    "first_released_energy": "energy released at the first slip",
    "loop_energy": "energy of a loop",
    "shear_strength": "τc",
    "friction_without_contact": "Fₛ without contact",
    "threshold_agreement": "R² of Eq. 6.9",
    "counter_body_youngs_modulus": "E",
    "counter_body_thickness": "h",
    "slide_approach": "δ",
    "slide_mean_pressure": "p",
    "pairing_lattice_constant": "l",
    "surface_length": "w",
}
"""Names of the config as they are read in a text."""
CHARACTERS = 18
"""Characters of the table's font in an inch."""
PADDING = 0.07
TINY = 1e-9
"""Numbers below it have more zeros than a cell of the table."""


def render_claims(plan: Mapping, paths: Mapping[str, str], targets: Mapping[str, str]) -> None:
    """Judge the claims of a chapter and write them.

    plan: `Plan.claims_settings`; paths: the datasets by study; targets: csv, png and pdf.
    """
    data = {study: dataset.read(path) for study, path in paths.items()}
    rows = verdicts(dict(plan["claims"]), data)
    number = plan["chapter"].removeprefix("ch")
    figure = drawn(rows, f"Chapter {number}: what it states, and what was found", made_text(data))
    save(figure, rows, targets)


def drawn(rows: pd.DataFrame, title: str, footer: str) -> Figure:
    """The table: a head, one row a claim as high as its longest cell, and a footer."""
    table = [{name: head for name, (head, _) in COLUMNS.items()}, *map(_cells, rows.to_dict("records"))]
    widths = [width for _, width in COLUMNS.values()]
    left = np.cumsum([0.1, *widths])
    heights = [(max(cell.count("\n") for cell in row.values()) + 1) * LINE_INCHES + PADDING for row in table]
    made = textwrap.wrap(footer, int(left[-1] * 22))
    total = 0.35 + sum(heights) + (len(made) + 1) * LINE_INCHES
    figure = Figure(figsize=(left[-1] + 0.1, total))
    axes = figure.add_axes((0, 0, 1, 1), xlim=(0, left[-1] + 0.1), ylim=(total, 0))
    axes.axis("off")
    axes.text(left[0], 0.22, title, fontsize=9.5)
    top = 0.35
    for row, height, colour in zip(table, heights, ["#ffffff", *rows.verdict.map(COLOURS)], strict=True):
        for x, width, (name, cell) in zip(left, widths, row.items(), strict=False):
            if name == "verdict":
                axes.fill_between([x, x + width], top, top + height, color=colour, lw=0)
            axes.text(x + 0.04, top + PADDING / 2, cell, fontsize=7, va="top", linespacing=1.1)
        top += height
        axes.plot(left[[0, -1]], [top, top], color="#bbbbbb", lw=0.6)
    axes.text(left[0], top + LINE_INCHES / 2, "\n".join(made), fontsize=6, color="#777777", va="top")
    return figure


def _cells(row: dict) -> dict[str, str]:
    """The text of each cell; under a condition, what was found there follows the verdict."""
    texts = {name: row[name] for name in ("source", "statement", "expected", "because", "verdict")}
    texts["measure"] = compared(row["measure"])
    numbers = ("value", "ensemble_error", "grid_error")
    texts |= dict(zip(numbers, rounded(*(row[name] for name in numbers)), strict=True))
    if row["condition"]:
        found = rounded(*(row[f"condition_{name}"] for name in numbers))
        texts["verdict"] += f": {row['condition']}; there " + "\N{NO-BREAK SPACE}±\N{NO-BREAK SPACE}".join(found)
    cells = {name: text.replace("κ_r", "κᵣ").replace("p_r*", "pᵣ*") for name, text in texts.items()}
    return {name: textwrap.fill(cells[name], int(width * CHARACTERS)) for name, (_, width) in COLUMNS.items()}


def compared(measure: str) -> str:
    """What a statement is compared by, with symbols for the names of quantities."""
    return " ".join(symbol(word).replace("_", " ") for word in measure.split())


def symbol(name: str) -> str:
    """A name of the config in symbols; other words as they are."""
    errors = {f"_{kind}_error": f"{kind.replace('_', ' ')} error of " for kind in dataset.ERRORS}
    for suffix, words in (errors | {LIMIT: "limit of "}).items():
        if name.endswith(suffix):
            return words + symbol(name.removesuffix(suffix))
    return SYMBOLS.get(name, name)


def rounded(value: float, *errors: float) -> list[str]:
    """A value and its errors: errors to two digits, the value to the place of the smallest that is not zero.

    Without an error the value has four digits; a dash stands for what is unknown. What rounding leaves of a zero, and
    anything else as small, is written with a power of ten.
    """
    if 0 < abs(value) < TINY:
        return [f"{number:.1e}" if np.isfinite(number) else "–" for number in (value, *errors)]
    places = {error: _places(error, 2) for error in errors if np.isfinite(error) and error > 0}
    finest = places[min(places)] if places else _places(value, 4)
    texts = [f"{value:.{finest}f}" if np.isfinite(value) else "–"]
    return texts + [f"{error:.{places.get(error, 0)}f}" if np.isfinite(error) else "–" for error in errors]


def _places(value: float, digits: int) -> int:
    """Decimals that show so many significant digits."""
    return max(0, digits - 1 - int(f"{abs(value):.{digits - 1}e}".split("e")[1])) if np.isfinite(value) else 0


def made_text(data: Mapping[str, xr.Dataset]) -> str:
    """Tier, and of each dataset its grid, members and unconverged solutions; what the errors are."""
    settings = {study: dataset.settings_of(one) for study, one in data.items()}
    parts = [f"{tier} tier" for tier in sorted({one["tier"] for one in settings.values()})]
    for study, one in data.items():
        lost, total = ensemble.unconverged(one)
        members = f"{one.member.size} members" if one.member.size > 1 else "1 member"
        points = style.points_text(settings[study], *one.points.values.ravel())
        parts.append(f"{study}: {points}, {members}, {lost} of {total} solutions unconverged and left out")
    parts.append("errors to two digits; ensemble error: one standard error over members")
    parts.append("grid error: change on halving the points, and what the increments of a path leave open")
    parts.append("not decidable: an edge of the band is nearer than both errors in quadrature")
    return " · ".join(parts)
