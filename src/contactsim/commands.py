"""The commands of `contactsim`: each is given the options of the command line."""

from __future__ import annotations

import argparse
import json
import sys
import textwrap
from dataclasses import replace
from pathlib import Path

import numpy as np
import xarray as xr

from contactsim import dataset, seals
from contactsim.analysis.table_comparison import difference_text, is_within
from contactsim.error_control.effect_maps import neglect_effects
from contactsim.error_control.forecast import describe_forecasts, forecast_run
from contactsim.error_control.ladder import solve_to_error
from contactsim.error_control.options import choose_options
from contactsim.errors import InputError
from contactsim.evaluation import estimate
from contactsim.explanation import explain_setup
from contactsim.files import prepare_target
from contactsim.observables.dataset_forms import form_of
from contactsim.paths.driver import follow_path
from contactsim.paths.options import Accuracy
from contactsim.scene_files import find_study
from contactsim.status import Status, is_solved, warn_of_excess
from contactsim.study import tier_comparison
from contactsim.study.execute import label_run
from contactsim.study.plan import Plan
from contactsim.study.scenes import build_setup, updated_settings
from contactsim.study.select_effects import select_effects
from contactsim.study.study import Study

DRAWN = (".png", ".pdf", ".svg")
PRINTED_VARIABLES = (
    *(
        "mean_pressure",
        "relative_contact_area",
        "relative_contact_area_subgrid",
        "kappa",
        "kappa_r",
        "mean_gap",
        "max_contact_gap",
    ),
    *("approach", "sliding_distance", "line_load", "friction_force", "contact_length", "max_interpenetration", "slip"),
    *("residual", "jump", "validity_flags", "transforms", "status"),
)
"""Variables of a simulation that are printed, as far as it has them."""
MAX_HEAD_WIDTH = 17
"""Most letters in a line of a column's name."""


def explain_scene(options: argparse.Namespace) -> None:
    """Print what a scene does and costs; draw it if asked to."""
    if options.draw and Path(options.draw).suffix not in DRAWN:
        raise InputError("--draw", options.draw, f"a name ending in one of {', '.join(DRAWN)}")
    study = find_study(options.scene, options.tier, options.changes)
    setup, runs = study.runs()[0].setup, len(study.runs())
    points = " × ".join(map(str, setup.scene.upper.surface.shape(setup.points)))
    which = "" if runs == 1 else f", the first of {runs} runs"
    sys.stdout.write(f"{study.settings['title']}: {points} points{which}\n")
    sys.stdout.write(explain_setup(setup, study.settings["neglect"]).text + "\n")
    if options.draw:
        from contactsim.figures.sketch import save_sketch

        save_sketch(setup.scene, setup.points, options.draw)


def run_scene(options: argparse.Namespace) -> None:
    """Simulate a scene and write its dataset beside its file, or where asked; fail if a step did not converge."""
    study = find_study(options.scene, options.tier, options.changes)
    if len(study.runs()) > 1:
        many = f"a study of one run; this has {len(study.runs())}: snakemake --cores 2 {options.scene}"
        raise InputError("scene", options.scene, many)
    target = options.output or f"{Path(options.scene).with_suffix('')}.nc"
    prepare_target(target, "--output")
    data, settings = _simulate_study(study, options.threads)
    warn_of_excess(data)
    data = _label_as_study(data, settings)
    source, replaced = study.runs()[0].source, Path(target).exists()
    dataset.write(dataset.stamp(data, study.settings["title"], settings, source), target)
    sys.stdout.write(f"{_table(data)}\n")
    if "accuracy" in data:
        sys.stdout.write(f"{_describe_accuracy(data)}\n")
    sys.stdout.write(f"{'replaced' if replaced else 'written to'} {target}\n")
    failed = int((~is_solved(data.status)).sum())
    if failed:
        sys.exit(f"Error: {failed} of {data.status.size} load steps did not converge")


def _table(data: xr.Dataset) -> str:
    """Return a line for each load, below the names of variables, broken after underscores, and their units."""
    names = {status.value[0]: status.name.lower() for status in Status}
    rows = data[[name for name in PRINTED_VARIABLES if name in data]].to_dataframe().reset_index()
    rows["status"] = [names[status] for status in rows.status]
    columns = []
    for name, values in rows.items():
        unit = data[name].attrs["units"]
        head = [*textwrap.wrap(name.replace("_", "_ "), MAX_HEAD_WIDTH), "" if unit == "1" else unit]
        columns.append([part.replace("_ ", "_") for part in head] + [_cell(value) for value in values])
    tall, widths = max(map(len, columns)), [max(map(len, column)) for column in columns]
    lines = zip(*([""] * (tall - len(column)) + column for column in columns), strict=True)
    return "\n".join(estimate.align_right(line, widths).rstrip() for line in lines)


def _cell(value: object) -> str:
    """Return a value as text."""
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _describe_accuracy(data: xr.Dataset) -> str:
    """Return the estimated relative errors of a run to an accuracy, in words."""
    ending = "_estimated_error"
    names = [str(name).removesuffix(ending) for name in data if str(name).endswith(ending)]
    errors = {name: float((data[name + ending] / np.abs(data[name])).max()) for name in names}
    reached = "reached" if data.accuracy_reached else "not reached"
    told = [f"no {name}" if np.isnan(error) else f"{name} to {error:.2g}" for name, error in errors.items()]
    estimates = ", ".join(told)
    return f"relative error {float(data.accuracy):g} {reached} on {int(data.points)} points: {estimates}, as estimated"


def _simulate_study(study: Study, threads: int) -> tuple[xr.Dataset, dict]:
    """Return the simulation of a study's first run, and its settings with what was neglected and chosen."""
    settings = study.runs()[0].settings
    setup = build_setup(settings, threads)
    if "auto" in settings:
        decision = select_effects(settings)
        sys.stdout.write(f"{decision.description}\n")
        setup, settings = neglect_effects(setup, decision.neglected), settings | {"neglect": decision.neglected}
    accuracy = setup.options.accuracy
    if accuracy is None:
        return follow_path(setup), settings
    controlled = solve_to_error(setup, accuracy.error, accuracy.quantities)
    return controlled.data, updated_settings(settings, controlled.last.setup)


def estimate_cost(options: argparse.Namespace) -> None:
    """Print what a scene, each run of a study or every figure is expected to cost, as it is or to an accuracy."""
    if options.scene is None:
        if options.accuracy is not None:
            raise InputError("--accuracy", options.accuracy, "none without a scene or a study")
        sys.stdout.write(estimate.cost_table("config", Plan.read("config", options.tier)))
        return
    study = find_study(options.scene, options.tier, options.changes, options.accuracy)
    runs = [run for run in study.runs() if not run.measures_error]
    setups = [run.setup for run in runs]
    try:
        if options.accuracy is not None:
            wanted = Accuracy(options.accuracy, tuple((study.settings["accuracy"] or {"quantities": ()})["quantities"]))
            setups = [
                choose_options(setup, wanted.error, wanted.quantities).with_options(accuracy=wanted) for setup in setups
            ]
        text = describe_forecasts(setups, [forecast_run(setup) for setup in setups])
        note = "with all effects: what is negligible is found out by the run\n"
        sys.stdout.write(text + note * ("auto" in runs[0].settings))
    except InputError as error:
        raise error.located(study.file) from error


def _label_as_study(data: xr.Dataset, settings: dict) -> xr.Dataset:
    """Return a simulation with its own load as dimension and the numbers that follow from it, as in a study."""
    data = label_run(data, settings, [""] * data.step.size).drop_vars("point_digest")
    form = form_of(data)
    return data if form.is_path else dataset.describe(form.derive(data))


def compare_tiers(options: argparse.Namespace) -> None:
    """Print how far the figures that two tiers have differ, and which are missing; exit code 1 where one is too far."""
    default = Plan.read("config", None)
    plans = [_plan_of_results(name, default) for name in (options.first, options.second)]
    missing = {plan.tier: _missing_figures(plan) for plan in plans}
    absent = {name for names in missing.values() for name in names}
    shared = {name: figure for name, figure in plans[1].figures.items() if name not in absent}
    lists = "".join(_missing_text(plan, missing[plan.tier]) for plan in plans if missing[plan.tier])
    if absent and not any(figure.compare for figure in shared.values()):
        sys.exit(f"Error: {options.first} and {options.second} have no figure in common.\n{lists.rstrip()}")
    tables = tier_comparison.compare_tiers(plans[0], replace(plans[1], figures=shared))
    sys.stdout.write(f"{options.first} compared with {options.second}: differences are relative to {options.second}\n")
    sys.stdout.write(difference_text(tables, options.within) + lists)
    if not all(table is None or is_within(table, options.within) for table in tables.values()):
        sys.exit(1)


def _plan_of_results(name: str, default: Plan) -> Plan:
    """Return the plan of a tier; for a folder with results the plan of the default tier, with this folder."""
    is_folder = name not in default.tiers and (Path(name) / "figures").is_dir()
    return replace(default, tier=name, results=Path(name)) if is_folder else Plan.read("config", name)


def _missing_figures(plan: Plan) -> list[str]:
    """Return the figures of a tier that are to be compared and are not made."""
    folder = plan.results / "figures"
    return [name for name, figure in plan.figures.items() if figure.compare and not (folder / f"{name}.csv").exists()]


def _missing_text(plan: Plan, names: list[str]) -> str:
    """Return lines that name missing figures, and of a tier the command that makes them."""
    is_tier = plan.tier in plan.tiers
    place = "at the tier" if is_tier else "in"
    command = f". Make them with: make NAME TIER={plan.tier}" if is_tier else ""
    text = f"Missing {place} {plan.tier}: {', '.join(names)}{command}"
    return textwrap.fill(text, 120, break_on_hyphens=False) + "\n"


def verify_results(options: argparse.Namespace) -> None:
    """Print which results of a tier are not what their seals say; exit code 1 where there is one."""
    results = Plan.read("config", None).results if options.folder is None else Path(options.folder)
    count, wrong = seals.verify(results)
    for place, reason in wrong.items():
        sys.stdout.write(f"{results / place} {reason}\n")
    sys.stdout.write(f"{results}: {count} results with seals, {len(wrong) or 'none'} not as they should be\n")
    if wrong:
        sys.exit(1)


def print_schema(options: argparse.Namespace) -> None:
    """Print the JSON Schema of a chapter's settings."""
    from contactsim.study.schema import chapter_schema

    sys.stdout.write(json.dumps(chapter_schema(), indent=1, ensure_ascii=False) + "\n")
