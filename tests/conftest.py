"""What several tests need: the quick tier's results, made once, without the workflow."""

from __future__ import annotations

import fcntl
import json
import os
from concurrent.futures import ProcessPoolExecutor
from importlib import import_module
from multiprocessing import get_context
from pathlib import Path

import pandas as pd
import pytest

from contactsim import dataset
from contactsim.analysis import aggregate, costs
from contactsim.analysis.claims import judge_claims
from contactsim.figures.diagnostics.claims import write_claims
from contactsim.figures.layout import write_figure
from contactsim.files import write_text
from contactsim.study.execute import RunFiles
from contactsim.study.figure_plan import PICTURE_ENDINGS
from contactsim.study.law_table import tabulate_law
from contactsim.study.plan import Plan
from contactsim.study.run import Run
from contactsim.study.select_effects import select_effects
from contactsim.study.stages import STAGES
from contactsim.threads import limit_threads
from support.places import ROOT

os.environ["OPENBLAS_NUM_THREADS"] = "1"  # of processes that tests start; of this one, see below
FILES = (("datasets", ".nc"), ("costs", ".csv"))


def pytest_configure() -> None:
    """One BLAS thread, as `simulate` has: on small dense systems more would only wait for each other."""
    limit_threads(1)


def run_files(plan: Plan, stem: str) -> RunFiles:
    """Return the files of a run."""
    return RunFiles(plan.results / f"runs/{stem}.nc", plan.results / f"costs/runs/{stem}.json")


def compute_run(job: tuple[Run, RunFiles, Path | None, Path | None]) -> None:
    """Compute one run, in a process of its own."""
    run, files, decision, twin = job
    neglect = {name: file for name, file in {"decision": decision, "twin": twin}.items() if file}
    import_module(STAGES[run.stage][0]).run(run.settings, run.source, files, **neglect)


def decide_run(job: tuple[dict, Path]) -> None:
    """Select the effects that a variant neglects, in a process of its own."""
    settings, file = job
    write_text(select_effects(settings).text, file)


def draw_figure(plan: Plan, name: str) -> None:
    """Write one figure, in a process of its own."""
    figure = plan.figures[name]
    names, law = [plan.dataset_name(study) for study in figure.studies], figure.settings["law"]
    data = [dataset.load_dataset(plan.results / f"datasets/{study}.nc") for study in names]
    costs = [pd.read_csv(plan.results / f"costs/{study}.csv") for study in names]
    targets = {kind: f"{plan.results}/figures/{name}.{kind}" for kind in figure.endings}
    settings = json.loads(json.dumps(plan.figure_settings(name)))
    write_figure(settings, data if law is None else [tabulate_law(law)], costs, targets)


def assess_claims(plan: Plan, chapter: str) -> None:
    """Write the claims of one chapter, in a process of its own."""
    studies = plan.claims_studies(chapter)
    data = {study: dataset.load_dataset(plan.results / f"datasets/{chapter}_{study}.nc") for study in studies}
    targets = {kind: f"{plan.results}/claims/{chapter}.{kind}" for kind in PICTURE_ENDINGS}
    for study in plan.claims_costs(chapter):
        data[study] = costs.with_costs(data[study], costs.read_costs(plan.results / f"costs/{chapter}_{study}.csv"))
    settings = json.loads(json.dumps(plan.claims_settings(chapter)))
    write_claims(judge_claims(dict(settings["claims"]), data), chapter, data, targets)


def gather_study(plan: Plan, study: str) -> None:
    """Dataset and table of costs of a study."""
    settings, name = plan.study_settings(study), plan.dataset_name(study)
    data = aggregate.aggregate(settings["runs"], settings["settings"], settings["source"])
    dataset.write(data, plan.results / f"datasets/{name}.nc")
    costs.table(settings["runs"]).to_csv(plan.results / f"costs/{name}.csv", index=False)


@pytest.fixture(scope="session")
def made(tmp_path_factory) -> Path:
    """A folder in which `results/quick` holds everything of the quick tier, made by the first worker that needs it."""
    base = tmp_path_factory.getbasetemp()
    folder = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / "made"
    folder.mkdir(exist_ok=True)
    with (folder / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not (folder / "done").exists():
            make_quick_tier(folder)
            (folder / "done").touch()
    return folder


def make_quick_tier(folder: Path) -> None:
    """Runs, datasets, tables of costs, figures and claims of the quick tier."""
    before, jobs, decisions = Path.cwd(), [], []
    os.chdir(folder)
    try:
        plan = Plan.read(ROOT / "config", "quick")
        for study in plan.studies:
            for one, entry in zip(plan.studies[study].runs(), plan.study_settings(study)["runs"], strict=True):
                alike = tuple(run_files(plan, stem) for stem in plan.runs_alike.get(one.stem, []))
                files = RunFiles(entry["path"], entry["costs"], alike)
                jobs.append((one, files, plan.decision(one), plan.twin(one)))
                if plan.decision(one) and one.member == 0:
                    decisions.append((one.settings, plan.decision(one)))
        jobs.sort(key=lambda job: -job[0].setup.size)
        with ProcessPoolExecutor(2, get_context("spawn")) as pool:
            list(pool.map(decide_run, decisions))
            list(pool.map(compute_run, [job for job in jobs if not job[-1]]))
            list(pool.map(compute_run, [job for job in jobs if job[-1]]))
            gathered = [pool.submit(gather_study, plan, study) for study in plan.studies]
            for job in gathered:
                job.result()
        (plan.results / "figures").mkdir()
        (plan.results / "claims").mkdir()
        with ProcessPoolExecutor(2, get_context("spawn")) as pool:
            drawn = [pool.submit(draw_figure, plan, figure) for figure in plan.figures]
            drawn += [pool.submit(assess_claims, plan, chapter) for chapter in plan.claims]
            for job in drawn:
                job.result()
    finally:
        os.chdir(before)
