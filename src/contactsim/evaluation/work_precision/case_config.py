"""Read the cases of the work-precision study from their files, and what their figures depend on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from contactsim.error_control.forecast import forecast_setup
from contactsim.errors import NOTHING, InputError
from contactsim.evaluation.figure_settings import FIGURE_KEYS, FigureSettings
from contactsim.evaluation.work_precision.baselines import measured_dates
from contactsim.evaluation.work_precision.cases import REFERENCE, Case, CaseSettings, case_job
from contactsim.evaluation.work_precision.knobs import (
    Setting,
    SingleLoads,
    WholePath,
    WholeSlide,
    find_case_kind,
    read_knobs,
)
from contactsim.paths.driver import path_driver
from contactsim.provenance import digest
from contactsim.solvers.base import check_solver
from contactsim.solvers.registry import SOLVERS, solver_class
from contactsim.study.plain_yaml import load_yaml
from contactsim.study.plan import Plan
from contactsim.study.quantity_names import quantities
from contactsim.study.reading import (
    SAFE_NAME,
    SAFE_NAME_FORM,
    Key,
    choice,
    listed,
    mapping,
    number,
    positive,
    read,
    text,
    whole,
)
from contactsim.study.stages import stage_digest
from contactsim.study.study import Study
from contactsim.traits import Trait

MEASURED_QUANTITIES = (*SingleLoads.quantities, *WholeSlide.quantities)
CASE_KEYS = FIGURE_KEYS | {
    "study": Key(text, "the name of a study"),
    "vary": Key(mapping, "a mapping from keys that the study varies to lists of some of their values", {}),
    "load": Key(listed(number), "a list of the study's loads", None),
    "members": Key(whole(1), "a whole number, 1 or more", 1),
    "quantities": Key(listed(choice(MEASURED_QUANTITIES)), f"a list from {', '.join(MEASURED_QUANTITIES)}"),
    "settled": Key(mapping, "a value of each knob, at which the others are turned"),
    "reference": Key(mapping, "the value of each knob in the references"),
    "solvers": Key(mapping, "a mapping from solvers to the values of each knob"),
    "levels": Key(mapping, "from a knob to the errors at which solvers are compared"),
    "repeats": Key(whole(1), "how often each setting is timed, 1 or more", 1),
    "thesis_members": Key(whole(1), "the thesis's own number of members, 1 or more", None),
    "thesis_increment": Key(positive, "the thesis's own increment, a positive number", None),
}
KEPT_TIERS = "baselines_from_package"
"""Key of accuracy.yaml that is no tier."""


def read_cases(folder: str | Path, plan: Plan) -> dict[str, Case]:
    """Return the cases of accuracy.yaml at the plan's tier by name; none without that file."""
    file = Path(folder) / "accuracy.yaml"
    if not file.exists():
        return {}
    tiers, kept_tiers = _read_tiers(file)
    tiers = read(tiers, {name: Key(mapping, "a mapping of cases", {}) for name in plan.tiers}, file)
    cases = {name: _read_case(name, section, plan, file) for name, section in tiers[plan.tier].items()}
    if plan.tier in kept_tiers:
        return {name: replace(case, kept=measured_dates(case)) for name, case in cases.items()}
    return cases


def read_case(folder: str | Path, tier: str, name: str) -> Case:
    """Return one case of accuracy.yaml at a tier."""
    return read_cases(folder, Plan.read(folder, tier))[name]


def read_kept_tiers(folder: str | Path) -> list[str]:
    """Return the tiers of accuracy.yaml that take the results of baselines from the package."""
    return _read_tiers(Path(folder) / "accuracy.yaml")[1]


def _read_tiers(file: Path) -> tuple[dict[str, Any], list[str]]:
    """Return the sections of tiers by name, and the tiers that take the results of baselines from the package."""
    content = load_yaml(file)
    tiers = {name: section for name, section in content.items() if name != KEPT_TIERS}
    key = Key(listed(choice(tuple(tiers))), f"a list from {', '.join(tiers)}", [])
    given = {KEPT_TIERS: content[KEPT_TIERS]} if KEPT_TIERS in content else {}
    return tiers, read(given, {KEPT_TIERS: key}, file)[KEPT_TIERS]


def read_overview(folder: str | Path) -> FigureSettings | None:
    """Return the settings of the page of all cases; None without overview.yaml."""
    file = Path(folder) / "overview.yaml"
    return FigureSettings(**read(load_yaml(file), FIGURE_KEYS, file)) if file.exists() else None


def overview_figure_job(overview: FigureSettings, cases: Mapping[str, Case], tier: str) -> dict[str, Any]:
    """Return what the page of all cases depends on, apart from their tables."""
    panels = {
        name: {"title": case.settings.title.rpartition(": ")[2], "quantity": case.settings.quantities[0]}
        for name, case in cases.items()
    }
    return {
        "settings": overview.layout,
        "cases": panels,
        "kept": {name: dict(case.kept) for name, case in cases.items()},
        "tier": tier,
        "source": stage_digest("overview_figure"),
    }


def _read_case(name: str, section: object, plan: Plan, file: Path) -> Case:
    target = f"accuracy_{name}"
    if not SAFE_NAME.fullmatch(str(name)) or target in (*plan.reserved_names, *plan.studies, *plan.figures):
        allowed = f"{SAFE_NAME_FORM}; with accuracy_ before it no study's, figure's or rule's name"
        raise InputError(plan.tier, name, allowed, file)
    prefix = f"{plan.tier}.{name}"
    settings = read(section, CASE_KEYS, file, prefix)
    if settings["study"] not in plan.studies:
        raise InputError(f"{prefix}.study", settings["study"], f"one of {', '.join(plan.studies)}", file)
    study = plan.studies[settings["study"]]
    if study.settings["accuracy"] is not None:
        raise InputError(f"{prefix}.study", study.name, "a study whose knobs can be turned, without an accuracy", file)
    kind = find_case_kind(study)
    if kind is None:
        raise InputError(f"{prefix}.study", study.name, "a study of loads, or of a path of smooth laws", file)
    for key in {*settings["solvers"]} - {*SOLVERS}:
        raise InputError(f"{prefix}.solvers", key, f"one of {', '.join(sorted(SOLVERS))}", file)
    settings |= read_knobs(settings, kind, file, prefix)
    case_settings = CaseSettings(**settings)
    _check_keys(case_settings, study, kind, file, prefix)
    case = Case(name, case_settings, _select_values(study, case_settings.vary, file, f"{prefix}.vary"))
    if case.default not in case_settings.solvers:
        allowed = f"{case.default}, the study's own, among them: the measure of others"
        raise InputError(f"{prefix}.solvers", list(case_settings.solvers), allowed, file)
    for job in (REFERENCE, *case_settings.solvers):  # those that are not installed too
        for setting in case.settings_of(job):
            _check_setting(case, job, setting, file, prefix)
    return case


def _check_setting(case: Case, job: str, setting: Setting, file: Path, prefix: str) -> None:
    """Build the scenes of a job at one setting, so that an impossible one is refused before the job runs."""
    try:
        for run in case.study_at(setting, job).runs():
            scene = run.setup.scene
            scene.upper.surface.check(setting.points)
            check_solver(solver_class(case.solver_of(job))(), scene)
            path_driver(scene.kind).check(run.setup)
    except InputError as error:
        if error.key == "solver":
            raise InputError(f"{prefix}.solvers", job, error.allowed, file) from error
        section = REFERENCE if job == REFERENCE else f"solvers.{job}"
        raise error.located(file, f"{prefix}.{section if error.key == setting.knob else 'settled'}") from error


def _check_keys(settings: CaseSettings, study: Study, kind: SingleLoads | WholePath, file: Path, prefix: str) -> None:
    """Refuse loads and quantities that the study lacks, and keys that its kind does not use."""
    for key, why in kind.unused_keys.items():
        value = getattr(settings, key, None)
        if value is not None:
            raise InputError(f"{prefix}.{key}", value, why, file)
    if settings.load is None and "load" not in kind.unused_keys:
        raise InputError(f"{prefix}.load", NOTHING, f"{CASE_KEYS['load'].allowed} (the key is missing)", file)
    measured = [name for name in kind.quantities if name in quantities(study)]
    for key, allowed in (("load", study.settings["load"]["values"]), ("quantities", measured)):
        for value in getattr(settings, key) or ():
            if value not in allowed:
                raise InputError(f"{prefix}.{key}", value, f"the study's own: {', '.join(map(str, allowed))}", file)


def _select_values(study: Study, vary: Mapping[str, list], file: Path, prefix: str) -> Study:
    """Return the study restricted to some of its varied values."""
    for key, values in vary.items():
        varied = study.settings["vary"].get(key)
        if varied is None:
            allowed = f"a key that the study varies: {', '.join(study.settings['vary']) or 'none'}"
            raise InputError(f"{prefix}.{key}", values, allowed, file)
        if not isinstance(values, list) or not values or any(value not in varied for value in values):
            raise InputError(f"{prefix}.{key}", values, f"a list from {', '.join(map(str, varied))}", file)
    return replace(study, settings=study.settings | {"vary": {**study.settings["vary"], **vary}})


def read_all_tiers(folder: str | Path, plan: Plan) -> dict[str, Plan]:
    """Return the plans of all tiers by name; plan: the one that is not read again."""
    return {tier: plan if tier == plan.tier else Plan.read(folder, tier) for tier in plan.tiers}


def case_figure_job(case: Case, plan: Plan, tiers: Mapping[str, Plan]) -> dict[str, Any]:
    """Return what the figure of a case depends on.

    Its marks are each tier's value of each knob, and the thesis's where it is known; tiers: from `read_all_tiers`.
    """
    studies = {tier: plan.studies[case.study.name] for tier, plan in tiers.items()}
    shared = ("points", "tolerance", "members")
    marks: dict[str, dict[str, float]] = {
        tier: {knob: study.settings[knob] for knob in shared} | case.kind.knob_values(study)
        for tier, study in studies.items()
    }
    thesis = {"members": case.settings.thesis_members, "increment": case.settings.thesis_increment}
    thesis |= {"points": case.study.settings["thesis_points"]}
    return {
        "settings": case.settings.settings,
        "case": case.name,
        "jobs": case.shown_jobs(),
        "kept": dict(case.kept),
        "digests": [case_job(case, job) for job in case.jobs()],
        "marks": marks | {"thesis": {knob: value for knob, value in thesis.items() if value}},
        "tier": plan.tier,
        "default": case.default,
        "selection": case.selection,
        "expected": [[f"{value:.6g}" for value in costs] for costs in forecast_costs(case)],
        "loads": case.kind.loads(case.study, case.settings.load),
        "units": case.kind.units(case.study),
        "surface": Trait.SURFACE in case.study.runs()[0].setup.scene.traits,
        "source": stage_digest("work_precision_figure"),
        "study": digest(plan.study_settings(case.study.name)),
    }


def forecast_costs(case: Case) -> list[list[float]]:
    """Return the forecast work and units of time of every setting of the study's own solver; NaN without forecast."""
    costs = []
    for setting in case.settings_of(case.default):
        try:
            setups = [run.setup for run in case.study_at(setting, case.default).runs()]
            runs = [forecast_setup(setup) for setup in setups]
        except InputError:
            costs.append([float("nan")] * 2)
        else:
            total = setups[0].size
            costs.append([sum(run.transforms for run in runs) * total, sum(run.units for run in runs)])
    return costs
