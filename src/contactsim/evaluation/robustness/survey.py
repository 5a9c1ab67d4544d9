"""How solvers stand up to hazards: every case judged, and the map of outcomes.

A solver's outcome on a case is right, certified (the residual is met, no exact answer is known), refused with a reason
or an honest failure. An answer that is wrong or not finite must not occur. Each kind of case has a judge of its own.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path

import numpy as np
import xarray as xr

from contactsim import dataset
from contactsim.errors import InputError
from contactsim.evaluation.robustness.cases import Case
from contactsim.evaluation.robustness.judge_loads import judge_wall
from contactsim.evaluation.robustness.judge_paths import judge_path
from contactsim.evaluation.robustness.outcome import Outcome, Verdict
from contactsim.evaluation.robustness.path_cases import SLOWLY, PathCase
from contactsim.evaluation.robustness.registry import HAZARDS, first_line
from contactsim.provenance import computing_digest, digest, source_digest
from contactsim.solvers.base import HardWallSolver
from contactsim.solvers.cohesive.base import CohesiveSolver
from contactsim.solvers.registry import SOLVERS, make_solver, solver_class, solver_module
from contactsim.study.plan import Plan
from contactsim.study.reading import Key, choice, keys_of, listed, mapping, number, read, size, text, tiered

logger = logging.getLogger(__name__)


JUDGES: dict[type, Callable[..., Verdict]] = {Case: judge_wall, PathCase: judge_path}
"""Who judges which kind of case."""


def judge(case: Case | PathCase, method: str | HardWallSolver | CohesiveSolver) -> Verdict:
    """What comes of a case with a solver, by all that can be checked independently of it."""
    try:
        return JUDGES[type(case)](case, method)
    except InputError as error:
        return Verdict(Outcome.REFUSED, 0.0, str(error))


def _severities(value: object) -> list[float]:
    """Numbers from 0 to 100, rising."""
    found = listed(number)(value)
    if found != sorted(found) or found[0] < 0 or found[-1] > 100:
        raise ValueError
    return found


STABILITY_KEYS = {
    "title": Key(text, "a line of text"),
    "caption": Key(text, "text"),
    "size": Key(size, "width and height in inches"),
    "severities": Key(_severities, "a rising list of numbers from 0 to 100"),
    "solvers": Key(mapping, f"a mapping from solvers, of {', '.join(SOLVERS)}, to their options"),
    "hazards": Key(listed(choice(HAZARDS)), f"a list from {', '.join(HAZARDS)}", list(HAZARDS)),
}


def read_settings(section: object, file: object) -> dict:
    """Check the settings of the map, down to the options of every solver."""
    settings = read(section, STABILITY_KEYS, file)
    kinds = Key(mapping, "a mapping of the solver's options, {} for none", None)
    solvers = read(settings["solvers"], dict.fromkeys(SOLVERS, kinds), file, "solvers")
    settings["solvers"] = {}
    for name in (name for name in SOLVERS if solvers[name] is not None):
        options = read(solvers[name], keys_of(solver_class(name)), file, f"solvers.{name}")
        try:
            make_solver(name, **options)
        except InputError as error:
            raise error.located(file, f"solvers.{name}") from error
        settings["solvers"][name] = options
    if not settings["solvers"]:
        raise InputError("solvers", {}, f"at least one of {', '.join(SOLVERS)}", file)
    return settings


def read_stability(folder: str | Path, plan: Plan) -> dict | None:
    """Return the settings of stability.yaml at the plan's tier; None without that file."""
    section = tiered(Path(folder) / "stability.yaml", plan.overrides["stability"], plan.tier)
    return None if section is None else read_settings(*section)


def map_settings(settings: Mapping, plan: Plan) -> dict:
    """Return what the map of all hazards depends on."""
    hazards = settings["hazards"]
    shown = {key: settings[key] for key in ("title", "severities", "solvers", "hazards")} | {"tier": plan.tier}
    return {
        "paths": [f"{plan.results}/stability/{hazard}.nc" for hazard in hazards],
        "jobs": [job_settings(settings, hazard) for hazard in hazards],
        "settings": shown,
        "source": source_digest("contactsim.evaluation.robustness.survey"),
    }


def map_figure(settings: Mapping, plan: Plan) -> dict:
    """Return what the figure of the map depends on, in the form of `Plan.figure_settings`."""
    layout = {"panels": 2, "select": {}, "reference": {}, "law": None, "film": None}
    module = "contactsim.figures.diagnostics.stability"
    return {
        "name": "stability",
        "module": module,
        "settings": {key: settings[key] for key in ("title", "caption", "size")} | layout,
        "source": source_digest(module, "contactsim.figures.layout"),
        "data": digest(map_settings(settings, plan)),
    }


def job_settings(settings: Mapping, hazard: str) -> dict:
    """What the cells of one hazard depend on."""
    modules = [solver_module(name) for name in (*settings["solvers"], SLOWLY)]
    return {
        "hazard": hazard,
        "severities": settings["severities"],
        "solvers": settings["solvers"],
        "source": computing_digest("contactsim.evaluation.robustness.survey", *modules),
    }


def survey(hazard: str, severities: Sequence[float], solvers: Mapping[str, Mapping], source: str) -> xr.Dataset:
    """Every solver on one hazard at every severity: outcome, transforms and reason, by (solver, severity)."""
    cases = [HAZARDS[hazard](severity) for severity in severities]
    methods = {name: make_solver(name, **solvers[name]) for name in sorted(solvers)}
    verdicts = []
    for name, method in methods.items():
        for severity, case in zip(severities, cases, strict=True):
            verdicts.append(judge(case, method))
            logger.info("%s %g, %s: %s %s", hazard, severity, name, verdicts[-1].outcome.value[1], verdicts[-1].reason)
    cells = np.array([(verdict.outcome.value[0], verdict.transforms) for verdict in verdicts]).T
    shape, dims = (len(methods), len(cases)), ("solver", "severity")
    data = xr.Dataset(
        {
            "outcome": (dims, cells[0].astype(np.int8).reshape(shape)),
            "transforms": (dims, cells[1].reshape(shape)),
            "reason": (dims, np.array([verdict.reason for verdict in verdicts], object).reshape(shape)),
            "tolerance": ("severity", [case.tolerance for case in cases]),
            "applicable": (
                "solver",
                np.array([cases[0].kind <= method.accepts for method in methods.values()], np.int8),
            ),
            "difficulty": first_line(hazard),
        },
        coords={"hazard": hazard, "solver": list(methods), "severity": list(severities)},
    )
    settings = {"hazard": hazard, "severities": list(severities), "solvers": dict(solvers)}
    return dataset.stamped(_described(data), f"Stability: {hazard}", settings, source)


def gather(parts: Iterable[xr.Dataset], settings: Mapping, source: str) -> xr.Dataset:
    """The surveys of all hazards in one dataset, by (hazard, solver, severity)."""
    parts = [part.drop_encoding() for part in parts]  # or the first part's length would cut all text
    data = xr.concat(parts, "hazard", data_vars="all", coords="minimal", join="exact", combine_attrs="override")
    return dataset.stamped(_described(data), str(settings["title"]), settings, source)


def _described(data: xr.Dataset) -> xr.Dataset:
    data = dataset.described(data)
    values, meanings = [kind.value[0] for kind in Outcome], " ".join(kind.name.lower() for kind in Outcome)
    data["outcome"].attrs.update(flag_values=np.array(values, np.int8), flag_meanings=meanings)
    return data
