"""Modules that each stage of the workflow executes.

A job carries a digest of the code that it executes, so that an edit reruns what it changes and nothing else. The
modules named here are where that code begins; `contactsim.code_digest` follows their imports.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

from contactsim import code_digest
from contactsim.code_digest import computing_digest, source_digest
from contactsim.provenance import digest
from contactsim.variables import TABLE, read_table

STAGES: dict[str, tuple[str, ...]] = {
    "run": ("contactsim.study.execute",),
    "run_to_accuracy": ("contactsim.study.execute_to_accuracy",),
    "run_neglecting": ("contactsim.study.execute_neglecting",),
    "select_effects": ("contactsim.study.select_effects",),
    "aggregate": ("contactsim.analysis.aggregate", "contactsim.analysis.costs"),
    "figure": ("contactsim.figures.layout",),
    "figure_of_law": ("contactsim.figures.layout", "contactsim.study.law_table"),
    "claims": ("contactsim.analysis.claims", "contactsim.figures.diagnostics.claims"),
    "work_precision": ("contactsim.evaluation.work_precision.cases",),
    "export_baselines": ("contactsim.evaluation.work_precision.baselines",),
    "work_precision_figure": ("contactsim.figures.diagnostics.accuracy",),
    "price": ("contactsim.evaluation.work_precision.prices",),
    "price_figure": ("contactsim.figures.diagnostics.prices",),
    "overview_figure": ("contactsim.figures.diagnostics.overview",),
    "measure_scaling": ("contactsim.evaluation.calibration.fit",),
    "fit_scaling": ("contactsim.evaluation.calibration.fit",),
    "trial": ("contactsim.evaluation.calibration.trial",),
    "trials_figure": ("contactsim.figures.diagnostics.trials",),
    "measure_effects": ("contactsim.evaluation.effects.effect_cost",),
    "effects_figure": ("contactsim.figures.diagnostics.effects",),
    "measure_effect_map": ("contactsim.evaluation.effects.survey",),
    "maps_figure": ("contactsim.figures.diagnostics.effect_maps",),
    "candidate": ("contactsim.evaluation.identification.simulation",),
    "judge_candidates": ("contactsim.evaluation.identification.judgement",),
    "identification_figure": ("contactsim.figures.diagnostics.identification",),
    "hazard": ("contactsim.evaluation.robustness.survey",),
}
"""Modules by stage."""
REGISTRIES = frozenset(
    {
        "contactsim.elasticity.registry",
        "contactsim.interface.registry",
        "contactsim.paths.increments",
        "contactsim.surfaces.registry",
    }
)
"""Modules that import all classes of a sort; a run executes only those that its settings name."""


@cache
def stage_digest(stage: str, *modules: str) -> str:
    """Return a digest of the code of a stage and of further modules, and of the table of variables."""
    return digest(source_digest(*STAGES[stage], *modules), read_table(_table_of_variables()))


@cache
def computing_stage_digest(stage: str, *modules: str) -> str:
    """Return a digest of the code of a stage that computes results, and of the libraries.

    Units, long names and symbols of variables do not enter: they describe results, and change none. Datasets of studies
    get them when they are gathered.
    """
    return computing_digest(*STAGES[stage], *modules)


@cache
def run_digest(*modules: str) -> str:
    """Return a digest of the code of a run as its settings are; modules: those of the kinds that they name."""
    return computing_digest(*STAGES["run"], *modules, registries=REGISTRIES)


def _table_of_variables() -> Path:
    """Return the table of variables of the package whose code the digests are of."""
    return code_digest.package_root() / TABLE.name
