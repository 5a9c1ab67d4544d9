"""Fit the scaling relations of error and cost to measurements.

Every relation is a power law: a straight line through logarithms by least squares, with the scatter that remains.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import pandas as pd
import yaml
from scipy.optimize import least_squares

from contactsim.error_control.relations import Relation
from contactsim.error_control.scaling import DEFAULT_GRID_ORDER, GRID_ORDERS, LINE, PATH, ROUGH_PATH, SLIDE, SURFACE
from contactsim.errors import InputError
from contactsim.evaluation.calibration.measurement import MEASURED_QUANTITIES

ROUGH = ("hurst_exponent", "bandwidth", "rough")
ERROR_FEATURES = {
    LINE: ("one", "grid", "pressure", *ROUGH),
    SURFACE: ("one", "grid", "pressure", *ROUGH),
    PATH: ("one", "grid", "zone", "friction"),
    ROUGH_PATH: ("one", "grid", "hurst_exponent", "bandwidth", "strength"),
    SLIDE: ("one", "grid", "zone"),
}
WORK_FEATURES = {
    LINE: ("one", "area", "size", "tolerance", *ROUGH),
    SURFACE: ("one", "area", "size", "tolerance", *ROUGH),
    PATH: ("one", "steps", "zone", "grid", "deep", "coupled", "friction", "loose", "tight", "every"),
    ROUGH_PATH: (
        "one",
        "steps",
        "strength",
        "grid",
        "deep",
        "hurst_exponent",
        "bandwidth",
        "coupled",
        "friction",
        "tight",
        "every",
    ),
    SLIDE: ("one", "steps", "zone", "grid", "deep", "tight"),
}
OPTION_FEATURES = ("one", "tolerance", "loose", "tight", "every", "steps", "grid", "size")
"""Features that follow from a user's options: they do not put a scene outside the measured ranges."""
FITTED_ORDER = ("pull_off_load_loading", "static_friction", "final_load", "onset_contact_length")
"""Quantities whose order of convergence in the grid is fitted: it depends on the resolution of the process zone."""
INCREMENT_ORDERS = {"pull_off_load_loading": 1.0}
"""Powers of the increment that are prescribed: where jumps are found to some width, a fit sees little of it."""
NOISE, WRONG = {"points": 5e-4}, 0.15
"""Relative errors below and above which a setting is left out of the fit: noise, and the pre-asymptotic range."""
FAINT = 1e-6
"""The same noise of other knobs, which make only a part of the error."""
MIN_ROWS = 6
RIDGE_WEIGHT = 1e-3
"""Weight that keeps coefficients small where features are alike."""


@dataclass(frozen=True)
class PowerLaw:
    """Coefficients by feature, the standard deviation of the logarithms that remains, and the number of rows."""

    coefficients: Mapping[str, float]
    spread: float
    rows: int


def fit_relations(table: pd.DataFrame) -> dict[str, Any]:
    """Fit the relations of all families.

    Parameters
    ----------
    table : pandas.DataFrame
        Rows of `contactsim.evaluation.calibration.measurement.measure_scaling`.

    Returns
    -------
    dict
        Relations by family, and the seconds of the transform in which times are counted.
    """
    return {
        "unit": _round(table.unit.median()),
        "families": {kind: _fit_family(kind, rows) for kind, rows in table.groupby("kind", sort=False)},
    }


def _fit_family(kind: str, rows: pd.DataFrame) -> dict[str, Any]:
    """Fit the relations of one family to all its rows."""
    wall = kind in (LINE, SURFACE)
    other = "tolerance" if wall else "increment"
    fits: dict[str, dict[str, PowerLaw | None]] = {"points": {}, other: {}, "resolved": {}}
    grids, others = rows[rows.knob == "points"], rows[rows.knob == other]
    for name in MEASURED_QUANTITIES[kind]:
        column = f"error_{name}"
        order = GRID_ORDERS.get(name, DEFAULT_GRID_ORDER)
        prescribed = {} if name in FITTED_ORDER else {"grid": order}
        fits["points"][name] = fit_power_law(grids, column, ERROR_FEATURES[kind], prescribed)
        of_knob = {other: INCREMENT_ORDERS[name]} if name in INCREMENT_ORDERS else {}
        fits[other][name] = fit_power_law(others, column, ("one", other), of_knob)
        if wall:
            features = ("one", "resolved", "pressure", *ROUGH)
            fits["resolved"][name] = fit_power_law(grids, column, features, {"resolved": order})
    errors = {knob: {name: asdict(law) for name, law in laws.items() if law} for knob, laws in fits.items()}
    transforms = fit_power_law(rows[rows.knob != "warm_start"], "transforms", WORK_FEATURES[kind], {})
    if transforms is None:
        raise InputError(f"rows of {kind}", len(rows), f"at least {MIN_ROWS} with a count of transforms")
    law = Relation(transforms.coefficients, transforms.spread)
    shares = [row["transforms"] / law(row) for row in rows[rows.knob == "warm_start"].to_dict("records")]
    scene_features = ["bodies", "layers", *(name for name in WORK_FEATURES[kind] if name not in OPTION_FEATURES)]
    return {
        "errors": {knob: errors[knob] for knob in ("points", other)},
        "resolved": errors["resolved"],
        "transforms": asdict(transforms),
        "warm_start": _round(np.median(shares or [1.0])),
        "seconds": _fit_seconds(rows),
        "ranges": {name: [_round(rows[name].min()), _round(rows[name].max())] for name in scene_features},
    }


def fit_power_law(
    rows: pd.DataFrame, of: str, names: Sequence[str], prescribed: Mapping[str, float]
) -> PowerLaw | None:
    """Fit a straight line through logarithms.

    Parameters
    ----------
    rows : pandas.DataFrame
        Measurements, with a column for each feature, which is a logarithm.
    of : str
        Column of the fitted values.
    names : sequence of str
        Features.
    prescribed : mapping
        Coefficients that are not fitted, by feature.

    Returns
    -------
    PowerLaw or None
        Coefficients, the standard deviation of what remains and the number of rows; None where too few errors lie
        between noise and the largest error of the asymptotic range.
    """
    values = rows[of].to_numpy(float)
    good = np.isfinite(values) & (values > 0)
    if of.startswith("error"):
        good &= (values > NOISE.get(rows.knob.iloc[0], FAINT)) & (values < WRONG)
    if good.sum() < MIN_ROWS:
        return None
    rows, logs = rows[good], np.log(values[good])
    free = [name for name in names if name not in prescribed]
    matrix = rows[free].to_numpy(float)
    rest = logs - sum((rows[name].to_numpy(float) * factor for name, factor in prescribed.items()), np.zeros(len(rows)))
    penalty = np.sqrt(RIDGE_WEIGHT * max(len(rows), 1)) * np.diag([float(name != "one") for name in free])
    solution = np.linalg.lstsq(np.vstack([matrix, penalty]), np.concatenate([rest, np.zeros(len(free))]), rcond=None)[0]
    residual = rest - matrix @ solution
    if of.startswith("error"):  # errors change their sign: what counts is their size, not the middle of its logarithm
        solution[free.index("one")] += 0.5 * np.log(np.mean(np.exp(2 * residual)))
    coefficients = {name: _round(value) for name, value in zip(free, solution, strict=True)} | dict(prescribed)
    return PowerLaw(coefficients, _round(residual.std()), int(good.sum()))


def _fit_seconds(rows: pd.DataFrame) -> dict[str, float]:
    """Fit the seconds of a load or step, of a transform, and of points times their log2 to logarithms."""
    size, seconds = rows.total.to_numpy(float), rows.seconds.to_numpy(float)
    parts = np.stack([rows["count"], rows.transforms, rows.transforms * size * np.log2(size)], axis=1).astype(float)
    begin = np.log(np.median(seconds[:, None] / parts, axis=0) / len(parts.T))
    times = np.exp(least_squares(lambda logs: np.log(parts @ np.exp(logs) / seconds), begin, loss="soft_l1").x)
    return dict(zip(("step", "transform", "point"), map(_round, times), strict=True))


def _round(value: float) -> float:
    """Return a value with four digits, which is more than its accuracy."""
    return float(f"{value:.4g}")


def format_relations(table: pd.DataFrame) -> str:
    """Return the fitted relations as the text of their file."""
    head = (
        "# Relations between error and cost, measured by `snakemake fit_scaling`; see evaluation/calibration/fit.py\n"
    )
    return head + yaml.safe_dump(fit_relations(table), sort_keys=False, width=120, default_flow_style=None)
