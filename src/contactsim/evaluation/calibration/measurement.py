"""What accuracy costs, measured: scenes drawn at random, each solved on a ladder of every knob.

Every error is against a reference that is not on the ladder. `contactsim.evaluation.calibration.fit` fits relations to
them.
"""

from __future__ import annotations

import logging
import math
from collections.abc import Iterator

import numpy as np
import pandas as pd

from contactsim.error_control.control import Outcome, difference, outcome
from contactsim.error_control.forecast import transform_seconds, walk_features
from contactsim.error_control.options import by_increment, chosen, coarser, on_grid, on_points, paced_part
from contactsim.error_control.scaling import (
    COUNTED,
    LINE,
    MEASURES,
    PATH,
    ROUGH_PATH,
    SLIDE,
    SURFACE,
    contact_scale,
    kind_of,
)
from contactsim.evaluation.calibration.sampling import draw
from contactsim.provenance import computing_digest
from contactsim.solvers.registry import DEFAULT_SOLVERS, solver_module
from contactsim.study.keys import is_smooth
from contactsim.study.scenes import scene_of

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
    SLIDE: (*MEASURES[SLIDE], "onset_contact_length"),
}
"""Quantities whose errors relations are known of."""
TYPICAL = 0.02
"""Error asked of runs that begin from their companions."""


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


def plan(settings: dict, kind: str) -> dict:
    """What the measurements of one kind depend on; not on the relations that they begin from, or they never settled."""
    drawn = {"ranges": settings["kinds"][kind], **settings["calibration"]}
    source = computing_digest(
        "contactsim.evaluation.calibration.measurement", *(solver_module(name) for name in DEFAULT_SOLVERS.values())
    )
    return {"kind": kind, "drawn": drawn, "source": source}


def measured(plan: dict) -> pd.DataFrame:
    """All scenes of a kind on all ladders, with the unit that times are counted in."""
    kind, drawn = plan["kind"], plan["drawn"]
    tables = []
    for count in range(drawn["scenes"]):
        tables.append(measure(draw(kind, drawn["ranges"], drawn["seed"], count).settings).assign(scene=count))
        logger.info("scene %d of %d", count + 1, drawn["scenes"])
    return pd.concat(tables, ignore_index=True).assign(unit=transform_seconds())
