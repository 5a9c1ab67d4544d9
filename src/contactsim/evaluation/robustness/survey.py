"""Survey how robust the solvers are: every solver on every hazard, at every severity.

A wrong answer and one that is not finite must not occur; all other outcomes are honest.
"""

from __future__ import annotations

import logging
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from contactsim import dataset
from contactsim.errors import InputError, Words
from contactsim.evaluation.figure_settings import FIGURE_KEYS, FigureSettings
from contactsim.evaluation.robustness import path_cases, wall_path_cases
from contactsim.evaluation.robustness.judge import judge
from contactsim.evaluation.robustness.outcome import Outcome
from contactsim.evaluation.robustness.registry import HAZARDS, describe_hazard
from contactsim.provenance import digest
from contactsim.solvers.registry import SOLVERS, make_solver, solver_class, solver_module
from contactsim.study.plan import Plan
from contactsim.study.reading import Key, choice, keys_of, listed, mapping, number, read
from contactsim.study.stages import computing_stage_digest, stage_digest
from contactsim.study.tier_overrides import tiered

logger = logging.getLogger(__name__)


def _severities(value: object) -> list[float]:
    """Return numbers from 0 to 100 in rising order."""
    severities = listed(number)(value)
    if severities != sorted(severities) or severities[0] < 0 or severities[-1] > 100:
        raise ValueError
    return severities


ROBUSTNESS_KEYS = FIGURE_KEYS | {
    "severities": Key(_severities, "a rising list of numbers from 0 to 100"),
    "solvers": Key(mapping, f"a mapping from solvers, of {', '.join(SOLVERS)}, to their options"),
    "hazards": Key(listed(choice(HAZARDS)), f"a list from {', '.join(HAZARDS)}", list(HAZARDS)),
    "families": Key(mapping, "title, caption, size and hazards of the figure of families"),
}
FAMILY_KEYS = FIGURE_KEYS | {"hazards": Key(mapping, "a mapping from the name of a family to a list of its hazards")}


@dataclass(frozen=True)
class Families(FigureSettings):
    """The figure of families: hazards by the name of their family."""

    hazards: Mapping[str, Sequence[str]]


@dataclass(frozen=True)
class Robustness(FigureSettings):
    """The survey: severities from 0 to 100, options by the solver's name, names of hazards, and their families."""

    severities: Sequence[float]
    solvers: Mapping[str, Mapping[str, Any]]
    hazards: Sequence[str]
    families: Families


def read_robustness_section(section: object, file: object) -> Robustness:
    """Return the survey, checked down to the options of every solver."""
    settings = read(section, ROBUSTNESS_KEYS, file)
    kinds = Key(mapping, "a mapping of the solver's options, {} for none", None)
    solvers = read(settings["solvers"], dict.fromkeys(SOLVERS, kinds), file, "solvers")
    options_by_solver = {}
    for name in (name for name in SOLVERS if solvers[name] is not None):
        options = read(solvers[name], keys_of(solver_class(name)), file, f"solvers.{name}")
        try:
            make_solver(name, **options)
        except InputError as error:
            raise error.located(file, f"solvers.{name}") from error
        options_by_solver[name] = options
    if not options_by_solver:
        raise InputError("solvers", {}, f"at least one of {', '.join(SOLVERS)}", file)
    families = _read_families(settings["families"], file)
    return Robustness(**settings | {"solvers": options_by_solver, "families": families})


def _read_families(section: Mapping[str, Any], file: object) -> Families:
    """Return the figure of families; every hazard is in one of them."""
    settings = read(section, FAMILY_KEYS, file, "families")
    names = {name: Key(listed(choice(HAZARDS)), f"a list from {', '.join(HAZARDS)}") for name in settings["hazards"]}
    hazards = read(settings["hazards"], names, file, "families.hazards")
    hazard_names = [hazard for family in hazards.values() for hazard in family]
    for hazard in HAZARDS:
        if hazard_names.count(hazard) != 1:
            value = Words(f"{hazard} in {hazard_names.count(hazard)} families")
            raise InputError("families.hazards", value, "every hazard in one family", file)
    return Families(**settings | {"hazards": hazards})


def read_robustness(folder: str | Path, plan: Plan) -> Robustness | None:
    """Return the survey of stability.yaml at the plan's tier; None without that file."""
    section = tiered(Path(folder) / "stability.yaml", plan.overrides["stability"], plan.tier)
    return None if section is None else read_robustness_section(*section)


def robustness_job(robustness: Robustness, plan: Plan) -> dict[str, Any]:
    """Return what the dataset of all hazards depends on."""
    hazards, settings = robustness.hazards, robustness.settings
    shown = {key: settings[key] for key in ("title", "severities", "solvers", "hazards")} | {"tier": plan.tier}
    return {
        "paths": [f"{plan.results}/stability/{hazard}.nc" for hazard in hazards],
        "jobs": [hazard_job(robustness, hazard) for hazard in hazards],
        "settings": shown,
        "source": stage_digest("hazard"),
    }


def families_figure_job(robustness: Robustness, plan: Plan) -> dict[str, Any]:
    """Return what the figure of families depends on, in the form of `Plan.figure_settings`."""
    families = robustness.families
    pairs = [[name, list(hazards)] for name, hazards in families.hazards.items()]  # JSON sorts a mapping by its keys
    return _figure_job("robustness", families, 1, {"families": pairs}, robustness_job(robustness, plan))


def robustness_figure_job(robustness: Robustness, plan: Plan) -> dict[str, Any]:
    """Return what the figure of all hazards depends on, in the form of `Plan.figure_settings`."""
    return _figure_job("stability", robustness, 2, {}, robustness_job(robustness, plan))


def _figure_job(
    name: str, figure: FigureSettings, panels: int, reference: Mapping[str, Any], data: Mapping[str, Any]
) -> dict[str, Any]:
    """Return what a figure of the survey depends on: its name, which is that of its function, and its data."""
    layout = {"panels": panels, "rows": 1, "select": {}, "reference": reference, "law": None, "film": None}
    module = f"contactsim.figures.diagnostics.{name}"
    settings = figure.layout | layout
    source = stage_digest("figure", module)
    return {"name": name, "module": module, "settings": settings, "source": source, "data": digest(data)}


FIGURE_JOBS = {"robustness": families_figure_job, "stability": robustness_figure_job}
"""What the figures of the survey depend on, by their names."""


def hazard_job(robustness: Robustness, hazard: str) -> dict[str, Any]:
    """Return what the survey of one hazard depends on."""
    modules = [
        solver_module(name) for name in (*robustness.solvers, path_cases.BRANCH_SOLVER, wall_path_cases.BRANCH_SOLVER)
    ]
    return {
        "hazard": hazard,
        "severities": robustness.severities,
        "solvers": robustness.solvers,
        "source": computing_stage_digest("hazard", *modules),
    }


def survey_hazard(hazard: str, severities: Sequence[float], solvers: Mapping[str, Mapping], source: str) -> xr.Dataset:
    """Judge every solver on one hazard at every severity.

    Parameters
    ----------
    hazard : str
        Name of the hazard.
    severities : sequence of float
        From 0 to 100.
    solvers : mapping
        Options by the solver's name.
    source : str
        Digest of the code, which the dataset keeps.

    Returns
    -------
    xarray.Dataset
        Outcome, transforms and reason, dimensions (solver, severity).
    """
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
            "difficulty": describe_hazard(hazard),
        },
        coords={"hazard": hazard, "solver": list(methods), "severity": list(severities)},
    )
    settings = {"hazard": hazard, "severities": list(severities), "solvers": dict(solvers)}
    return dataset.stamp(_describe_outcomes(data), f"Stability: {hazard}", settings, source)


def merge_surveys(parts: Iterable[xr.Dataset]) -> xr.Dataset:
    """Return the surveys of all hazards in one dataset, dimensions (hazard, solver, severity)."""
    parts = [part.drop_encoding() for part in parts]  # or the first part's length would cut all text
    data = xr.concat(parts, "hazard", data_vars="all", coords="minimal", join="exact", combine_attrs="override")
    return _describe_outcomes(data)


def _describe_outcomes(data: xr.Dataset) -> xr.Dataset:
    """Return a survey with units, long names and the meanings of its outcomes."""
    data = dataset.describe(data)
    values, meanings = [kind.value[0] for kind in Outcome], " ".join(kind.name.lower() for kind in Outcome)
    data["outcome"].attrs.update(flag_values=np.array(values, np.int8), flag_meanings=meanings)
    return data
