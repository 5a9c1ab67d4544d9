"""Relations of accuracy and cost, fitted to what was measured.

Every relation is a straight line through logarithms, by least squares, with the scatter that remains.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
import yaml
from scipy.optimize import least_squares

from contactsim.error_control.scaling import (
    DEFAULT_GRID_ORDER,
    GRID_ORDERS,
    LINE,
    PATH,
    ROUGH_PATH,
    SLIDE,
    SURFACE,
    Relation,
)
from contactsim.evaluation.calibration.measurement import READ

ROUGH = ("hurst", "bandwidth", "rough")
ERROR_FEATURES = {
    LINE: ("one", "grid", "pressure", *ROUGH),
    SURFACE: ("one", "grid", "pressure", *ROUGH),
    PATH: ("one", "grid", "zone", "friction"),
    ROUGH_PATH: ("one", "grid", "hurst", "bandwidth", "strength"),
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
        "hurst",
        "bandwidth",
        "coupled",
        "friction",
        "tight",
        "every",
    ),
    SLIDE: ("one", "steps", "zone", "grid", "deep", "tight"),
}
CHOSEN = ("one", "tolerance", "loose", "tight", "every", "steps", "grid", "size")
"""Features that follow from what a user chooses: a scene is not outside what was measured because of them."""
STEEP = ("pull_off_load_loading", "static_friction", "final_load", "onset_contact_length")
"""Quantities whose error's order in the grid is fitted: the process zone is resolved or is not."""
NOISE, WRONG = {"points": 5e-4}, 0.15
"""Relative errors below which a setting of a knob says nothing of those that are asked for, and above which."""
FAINT = 1e-6
"""The same of other knobs, which are to make but a part of the error."""
FEWEST_ROWS = 6
RIDGE = 1e-3
"""Weight that keeps coefficients small where features are alike."""


def fit(table: pd.DataFrame) -> dict:
    """The relations of all kinds, and seconds of the transform that times are counted in."""
    return {
        "unit": _short(table.unit.median()),
        "families": {kind: _kind(kind, rows) for kind, rows in table.groupby("kind", sort=False)},
    }


def _kind(kind: str, rows: pd.DataFrame) -> dict:
    """The relations of one kind, from all rows of it."""
    wall = kind in (LINE, SURFACE)
    other = "tolerance" if wall else "increment"
    errors: dict[str, dict] = {"points": {}, other: {}, "resolved": {}}
    grids, others = rows[rows.knob == "points"], rows[rows.knob == other]
    for name in READ[kind]:
        known = f"error_{name}"
        order = None if name in STEEP else GRID_ORDERS.get(name, DEFAULT_GRID_ORDER)
        errors["points"][name] = _line(grids, known, ERROR_FEATURES[kind], {"grid": order} if order else {})
        errors[other][name] = _line(others, known, ("one", other), {})
        if wall:
            features = ("one", "resolved", "pressure", *ROUGH)
            errors["resolved"][name] = _line(grids, known, features, {"resolved": order})
    errors = {knob: {name: law for name, law in laws.items() if law} for knob, laws in errors.items()}
    transforms = _line(rows[rows.knob != "warm_start"], "transforms", WORK_FEATURES[kind], {})
    law = Relation(transforms["coefficients"], transforms["spread"])
    shares = [one["transforms"] / law(one) for one in rows[rows.knob == "warm_start"].to_dict("records")]
    seen = ["bodies", "layers", *(name for name in WORK_FEATURES[kind] if name not in CHOSEN)]
    return {
        "errors": {knob: errors[knob] for knob in ("points", other)},
        "resolved": errors["resolved"],
        "transforms": transforms,
        "warm_start": _short(np.median(shares or [1.0])),
        "seconds": _seconds(rows),
        "ranges": {name: [_short(rows[name].min()), _short(rows[name].max())] for name in seen},
    }


def _line(rows: pd.DataFrame, of: str, names: Sequence[str], known: Mapping[str, float]) -> dict | None:
    """A straight line through logarithms: coefficients of features, some of them known, and the scatter that is left.

    None where too few errors are of a size that tells.
    """
    values = rows[of].to_numpy(float)
    good = np.isfinite(values) & (values > 0)
    if of.startswith("error"):
        good &= (values > NOISE.get(rows.knob.iloc[0], FAINT)) & (values < WRONG)
    if good.sum() < FEWEST_ROWS:
        return None
    rows, logs = rows[good], np.log(values[good])
    free = [name for name in names if name not in known]
    matrix = rows[free].to_numpy(float)
    rest = logs - sum((rows[name].to_numpy(float) * factor for name, factor in known.items()), np.zeros(len(rows)))
    penalty = np.sqrt(RIDGE * max(len(rows), 1)) * np.diag([float(name != "one") for name in free])
    found = np.linalg.lstsq(np.vstack([matrix, penalty]), np.concatenate([rest, np.zeros(len(free))]), rcond=None)[0]
    left = rest - matrix @ found
    if of.startswith("error"):  # errors change their sign: what counts is their size, not the middle of its logarithm
        found[free.index("one")] += 0.5 * np.log(np.mean(np.exp(2 * left)))
    coefficients = {name: _short(value) for name, value in zip(free, found, strict=True)} | dict(known)
    return {"coefficients": coefficients, "spread": _short(left.std()), "rows": int(good.sum())}


def _seconds(rows: pd.DataFrame) -> dict:
    """Seconds of a load or step, of a transform, and of points times their log2, by the logarithm."""
    size, seconds = rows.total.to_numpy(float), rows.seconds.to_numpy(float)
    parts = np.stack([rows["count"], rows.transforms, rows.transforms * size * np.log2(size)], axis=1).astype(float)
    begin = np.log(np.median(seconds[:, None] / parts, axis=0) / len(parts.T))
    found = np.exp(least_squares(lambda logs: np.log(parts @ np.exp(logs) / seconds), begin, loss="soft_l1").x)
    return dict(zip(("step", "transform", "point"), map(_short, found), strict=True))


def _short(value: float) -> float:
    """Four digits, which is more than is known."""
    return float(f"{value:.4g}")


def as_text(table: pd.DataFrame) -> str:
    """The relations as their file has them."""
    head = "# Relations of accuracy and cost, measured by `snakemake relations`; see contactsim/regression.py\n"
    return head + yaml.safe_dump(fit(table), sort_keys=False, width=120, default_flow_style=None)
