"""What accuracy costs: one scene of each kind, solved to smaller and smaller errors.

Runs that would take too long are forecast alone. Times are counted in transforms of 4096 points, so that the same are
solved on every machine.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from contactsim import dataset
from contactsim.error_control.forecast import forecast_setup, forecast_to_error, transform_seconds
from contactsim.error_control.ladder import largest_error, solve_to_error, solve_with_errors
from contactsim.error_control.options import choose_options, coarser_setups
from contactsim.error_control.scaling import FILE
from contactsim.error_control.solution import solve_setup
from contactsim.errors import InputError
from contactsim.evaluation.figure_settings import FIGURE_KEYS, FigureSettings
from contactsim.paths.options import Setup
from contactsim.provenance import digest
from contactsim.solvers.registry import solver_module
from contactsim.study.keys import ACCURACY_KEYS
from contactsim.study.plan import Plan
from contactsim.study.reading import Key, choice, listed, mapping, positive, read, text
from contactsim.study.scenes import build_setup
from contactsim.study.stages import computing_stage_digest, stage_digest
from contactsim.study.tier_overrides import tiered

NAME = "price_of_accuracy"
"""Name of the figure and of its file of settings."""
KEYS = FIGURE_KEYS | {
    "errors": Key(listed(ACCURACY_KEYS["error"].kind), "a list of relative errors, above 0 and below 1"),
    "limit": Key(positive, "transforms of 4096 points, above which a run is forecast and not solved"),
    "scenes": Key(mapping, "a mapping from names to a title and a study"),
}
GROWTH = 4.0
"""Least cost of a run over that of the one before it, from which its cost is expected too."""


@dataclass(frozen=True)
class PricedScene:
    """One kind of scene.

    Parameters
    ----------
    title
        Words for the kind.
    run
        Settings of the first run of its study.
    thesis_points
        Points of the thesis; None where it has no such scene.
    """

    title: str
    run: Mapping[str, Any]
    thesis_points: int | None

    @property
    def setup(self) -> Setup:
        """Scene and options."""
        return build_setup(self.run)


@dataclass(frozen=True)
class PriceJob:
    """The measurement of one scene: the errors asked for, the largest first, and the longest run that is solved."""

    scene: PricedScene
    errors: Sequence[float]
    limit: float

    @classmethod
    def from_settings(cls, settings: Mapping[str, Any]) -> PriceJob:
        """Return the job from its JSON, the settings of `price_job`."""
        return cls(PricedScene(**settings["scene"]), settings["errors"], settings["limit"])


@dataclass(frozen=True)
class Prices(FigureSettings):
    """The errors asked for, the longest runs, and the scenes by name."""

    errors: Sequence[float]
    limit: float
    scenes: Mapping[str, PricedScene]


def read_prices(folder: str | Path, plan: Plan) -> Prices | None:
    """Return the settings of price_of_accuracy.yaml at the plan's tier; None without that file."""
    source = tiered(Path(folder) / f"{NAME}.yaml", plan.overrides[NAME], plan.tier)
    if source is None:
        return None
    section, file = source
    settings = read(section, KEYS, file)
    keys = {
        "title": Key(text, "a line of text"),
        "study": Key(choice(tuple(plan.studies)), "the name of a study"),
    }
    scenes = {}
    for name, scene in settings["scenes"].items():
        keyed = read(scene, keys, file, f"scenes.{name}")
        study = plan.studies[keyed["study"]]
        run = study.runs()[0].settings
        scenes[name] = PricedScene(keyed["title"], run, study.settings["thesis_points"])
    return Prices(**settings | {"scenes": scenes})


def price_job(prices: Prices, name: str) -> dict[str, Any]:
    """Return what the prices of a scene depend on."""
    scene = prices.scenes[name]
    module = solver_module(scene.run["solver"]["kind"])
    source = digest(computing_stage_digest("price", module), FILE.read_text(encoding="utf-8"))
    job = PriceJob(scene, sorted(prices.errors, reverse=True), prices.limit)
    return {"settings": asdict(job), "source": source}


def prices_figure_job(prices: Prices, tier: str) -> dict[str, Any]:
    """Return what the figure of all scenes depends on."""
    return {
        "settings": prices.layout,
        "titles": {name: scene.title for name, scene in prices.scenes.items()},
        "tier": tier,
        "source": stage_digest("price_figure"),
        "data": digest([price_job(prices, name) for name in prices.scenes]),
    }


def measure_price(job: PriceJob) -> tuple[xr.Dataset, dict[str, Any]]:
    """Solve a scene to all errors, the largest first, as long as that is not too long.

    Returns
    -------
    data : xarray.Dataset
        For each error asked for: what was forecast, and the error, grid and work of what was solved; reproducible.
    costs : dict
        CPU seconds of each run that was solved, and of one transform of 4096 points.
    """
    setup = job.scene.setup
    rows, last = [], 0.0
    seconds: list[float] = []
    for error in job.errors:
        units = _predicted_units(setup, error)
        row = {"predicted_units": units}
        if np.fmax(units, GROWTH * last) <= job.limit:
            if not seconds:
                solve_setup(coarser_setups(choose_options(setup, error))[0], ())  # compiles the kernels
            begin = time.process_time()
            result = solve_to_error(setup, error)
            seconds.append(time.process_time() - begin)
            last = seconds[-1] / transform_seconds()
            row |= {
                "predicted_error": largest_error(result.errors),
                "accuracy_reached": int(result.met),
                "points": result.last.points,
                "work": result.work * result.last.size,
            }
        rows.append({"predicted_error": np.nan, "accuracy_reached": -1, "points": -1, "work": np.nan} | row)
    values = {name: ("requested_error", [row[name] for row in rows]) for name in rows[0]}
    data = xr.Dataset(values, {"requested_error": list(job.errors)})
    data = data.assign(dict(zip(("thesis_error", "thesis_units"), _price_of_thesis(job), strict=True)))
    return dataset.describe(data), {"seconds": seconds, "transform_seconds": transform_seconds()}


def _predicted_units(setup: Setup, error: float) -> float:
    """Return the time of a run to an error; NaN if it cannot be forecast."""
    try:
        return forecast_to_error(setup, error).units
    except InputError:
        return np.nan


def _price_of_thesis(job: PriceJob) -> tuple[float, float]:
    """Return error and units of time on the thesis's grid, by our solver; NaN where that takes too long."""
    points = job.scene.thesis_points
    setup = job.scene.setup.with_options(points=points, accuracy=None, increments=None)
    if points is None or forecast_setup(setup).units > job.limit:
        return np.nan, np.nan
    result = solve_with_errors(setup)
    return largest_error(result.errors), result.last.seconds / transform_seconds()
