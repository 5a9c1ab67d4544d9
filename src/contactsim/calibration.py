"""Relations of accuracy and cost, measured: scenes drawn at random, each solved on a ladder of every knob, and fitted.

Every error is against a reference that is not on the ladder; every relation is a straight line through logarithms, by
least squares, with the scatter that remains.
"""

from __future__ import annotations

import logging
import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np
import pandas as pd
import yaml
from scipy.optimize import least_squares

from contactsim.build import scene_of
from contactsim.choice import by_increment, chosen, coarser, on_grid, on_points, paced_part
from contactsim.confirm import Outcome, difference, outcome
from contactsim.draws import draw
from contactsim.forecast import transform_seconds, walk_features
from contactsim.provenance import source_digest
from contactsim.relations import (
    COUNTED,
    LINE,
    MEASURES,
    ORDERS,
    PATH,
    ROUGH_PATH,
    SECOND,
    SLIDE,
    SURFACE,
    Relation,
    contact_scale,
    kind_of,
)
from contactsim.schema import is_smooth
from contactsim.solvers import USUAL, module_of

logger = logging.getLogger(__name__)

RESOLUTIONS = {
    LINE: (4.0, 8.0, 16.0, 32.0, 64.0),
    SURFACE: (4.0, 6.0, 8.0, 12.0, 16.0),
    PATH: (1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 32.0),
    ROUGH_PATH: (4.0, 8.0, 16.0, 32.0),
    SLIDE: (1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0),
}
"""Points for each length that contacts are measured by, on the ladder of grids."""
FINEST = {LINE: 8.0, SURFACE: 2.5, PATH: 4.0, ROUGH_PATH: 4.0, SLIDE: 4.0}
"""How many times finer than the last of these the reference is."""
INCREMENTS = {PATH: (2.0, 1.0, 0.5, 0.2), ROUGH_PATH: (4.0, 2.0, 1.0), SLIDE: (1.0, 0.5, 0.25)}
"""Increments of the ladder, in the laws' length."""
SMALL = {PATH: 0.05, ROUGH_PATH: 0.5, SLIDE: 0.1}
"""Those of the references, and of the ladder of grids."""
WALL_TOLERANCES, PATH_TOLERANCES = (1e-1, 1e-2, 1e-3), (1e-3, 1e-4, 1e-5)
REFERENCE_TOLERANCE = {True: 1e-6, False: 1e-4}
READ = {
    LINE: (*MEASURES[LINE], COUNTED),
    SURFACE: (*MEASURES[SURFACE], COUNTED),
    PATH: MEASURES[PATH],
    ROUGH_PATH: MEASURES[ROUGH_PATH],
    SLIDE: (*MEASURES[SLIDE], "onset_repulsive_length"),
}
"""Quantities whose errors relations are known of."""
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
STEEP = ("pull_off_load_loading", "static_friction", "final_load", "onset_repulsive_length")
"""Quantities whose error's order in the grid is fitted: the process zone is resolved or is not."""
TYPICAL = 0.02
"""Error asked of runs that begin from their companions."""
NOISE, WRONG = {"points": 5e-4}, 0.15
"""Relative errors below which a setting of a knob says nothing of those that are asked for, and above which."""
FAINT = 1e-6
"""The same of other knobs, which are to make but a part of the error."""
FEWEST_ROWS = 6
RIDGE = 1e-3
"""Weight that keeps coefficients small where features are alike."""


def measure(run: dict) -> pd.DataFrame:
    """A scene on all ladders: one row a setting and load, with its features, errors, transforms and seconds.

    run: settings of a run, whose grid, tolerance and increments are of no account.
    """
    kind = kind_of(scene_of(run))
    rows = []
    for knob, base, ladder in _ladders(run, kind):
        reference = outcome(base, READ[kind])
        for settings in ladder:
            rows += _rows(knob, outcome(settings, READ[kind]), reference, kind)
    if not is_smooth(run):
        rows += _begun(run, kind)
    return pd.DataFrame(rows)


def _begun(run: dict, kind: str) -> list[dict]:
    """Rows of a run at a wall that begins from its companion."""
    fine = chosen(run, TYPICAL)
    before = outcome(coarser(fine) | {"keep": ["fields"]}, READ[kind])
    found = outcome(fine, READ[kind], begun=before)
    return _rows("begun", found, found, kind)


def _ladders(run: dict, kind: str) -> Iterator[tuple[str, dict, list[dict]]]:
    """Knob, settings of the reference, and those of the ladder."""
    scene, smooth = scene_of(run), is_smooth(run)
    steps = [step.value for step in scene.path.steps] if not smooth else [0.0]
    scale = min(contact_scale(scene, value) for value in steps)

    def on(resolution: float, **more: object) -> dict:
        """Settings at that many points for each length of contact."""
        return on_points(run | more, resolution * scene.length / scale)

    tight = {"tolerance": REFERENCE_TOLERANCE[smooth]}
    resolutions = RESOLUTIONS[kind]
    usual = tight | (by_increment(run, SMALL[kind]) if smooth else {})
    yield "points", on(FINEST[kind] * resolutions[-1], **usual), [on(value, **usual) for value in resolutions]
    middle = resolutions[len(resolutions) // 2]
    if smooth:
        rest = {"tolerance": 1e-4}
        ladder = [on(middle, **rest, **by_increment(run, value)) for value in INCREMENTS[kind]]
        if kind in (PATH, ROUGH_PATH):  # the same with every increment solved, for their cost
            ladder += [one | {"increments": {"kind": "requested"}} for one in ladder[1:2]]
        yield "increment", on(middle, **rest, **by_increment(run, SMALL[kind])), ladder
        yield (
            "tolerance",
            on(middle, **usual),
            [on(middle, **usual | {"tolerance": value}) for value in PATH_TOLERANCES],
        )
    else:
        yield "tolerance", on(middle, **tight), [on(middle, tolerance=value) for value in WALL_TOLERANCES]


def _rows(knob: str, found: Outcome, reference: Outcome, kind: str) -> list[dict]:
    """One row a load, or one for a path."""
    scene = scene_of(found.settings)
    places = on_grid(scene, found.points)
    part = paced_part(found.settings)
    rows = []
    for count, one in enumerate(places):
        row = {"kind": kind, "knob": knob, **one, **walk_features(found.settings), "points": found.points}
        row["increment"] = math.log(found.settings[part].get("increment", 1.0))
        row["resolved"] = math.log(max(found.resolved[count], 1e-9)) if found.resolved.size else np.nan
        for name in READ[kind]:
            row[f"error_{name}"] = difference(reference, found, name)[count]
        steps = found.data.step.size
        row["count"] = 1 if found.resolved.size else steps
        row["transforms"] = float(found.data.transforms[count]) if found.resolved.size else found.transforms
        row["seconds"] = float(found.data.seconds[count]) if found.resolved.size else found.seconds
        row["total"] = found.size
        rows.append(row)
    return rows


def fit(table: pd.DataFrame) -> dict:
    """The relations of all kinds, and seconds of the transform that times are counted in."""
    return {
        "unit": _short(table.unit.median()),
        "kinds": {kind: _kind(kind, rows) for kind, rows in table.groupby("kind", sort=False)},
    }


def _kind(kind: str, rows: pd.DataFrame) -> dict:
    errors: dict[str, dict] = {"points": {}}
    resolved = {}
    grids = rows[rows.knob == "points"]
    for name in READ[kind]:
        known = f"error_{name}"
        order = None if name in STEEP else ORDERS.get(name, SECOND)
        errors["points"][name] = _line(grids, known, ERROR_FEATURES[kind], {"grid": order} if order else {})
        if kind in (LINE, SURFACE):
            resolved[name] = _line(grids, known, ("one", "resolved", "pressure", *ROUGH), {"resolved": order})
    if kind in (LINE, SURFACE):
        errors["tolerance"] = {
            name: _line(rows[rows.knob == "tolerance"], f"error_{name}", ("one", "tolerance"), {})
            for name in READ[kind]
        }
    else:
        errors["increment"] = {
            name: _line(rows[rows.knob == "increment"], f"error_{name}", ("one", "increment"), {})
            for name in READ[kind]
        }
    seen = ["bodies", "layers"] + [
        name
        for name in WORK_FEATURES[kind]
        if name not in ("one", "tolerance", "loose", "tight", "every", "steps", "grid", "size")
    ]
    errors = {knob: {name: law for name, law in laws.items() if law} for knob, laws in errors.items()}
    resolved = {name: law for name, law in resolved.items() if law}
    transforms, begun = (
        _line(rows[rows.knob != "begun"], "transforms", WORK_FEATURES[kind], {}),
        rows[rows.knob == "begun"],
    )
    law = Relation(transforms["coefficients"], transforms["spread"])
    shares = [one["transforms"] / law(one) for one in begun.to_dict("records")]
    return {
        "errors": errors,
        "resolved": resolved,
        "transforms": transforms,
        "begun": _short(np.median(shares or [1.0])),
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


def plan(settings: dict, kind: str) -> dict:
    """What the measurements of one kind depend on."""
    drawn = {"ranges": settings["kinds"][kind], **settings["calibration"]}
    source = source_digest("contactsim.calibration", *(module_of(usual) for usual in USUAL.values()))
    return {"kind": kind, "drawn": drawn, "source": source}


def measured(plan: dict) -> pd.DataFrame:
    """All scenes of a kind on all ladders, with the unit that times are counted in."""
    kind, drawn = plan["kind"], plan["drawn"]
    tables = []
    for count in range(drawn["scenes"]):
        tables.append(measure(draw(kind, drawn["ranges"], drawn["seed"], count).settings).assign(scene=count))
        logger.info("scene %d of %d", count + 1, drawn["scenes"])
    return pd.concat(tables, ignore_index=True).assign(unit=transform_seconds())


def as_text(table: pd.DataFrame) -> str:
    """The relations as their file has them."""
    head = "# Relations of accuracy and cost, measured by `snakemake relations`; see contactsim/calibration.py\n"
    return head + yaml.safe_dump(fit(table), sort_keys=False, width=120, default_flow_style=None)
