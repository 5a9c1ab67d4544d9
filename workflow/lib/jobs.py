"""What each job needs, depends on and asks for, as functions of its wildcards.

Parameters are JSON of exactly what a job uses, with a digest of its code: Snakemake compares them to find what an edit
changes. They are computed for the jobs of a target alone.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from products import Products
from snakemake.iocontainers import Wildcards

import snakemake_logger_plugin_progress
from contactsim.evaluation.calibration import settings as calibration
from contactsim.evaluation.effects import effect_cost
from contactsim.evaluation.effects import survey as effect_survey
from contactsim.evaluation.robustness import survey as hazard_survey
from contactsim.evaluation.work_precision import case_config, cases, prices
from contactsim.provenance import canonical
from contactsim.study.plan import Plan
from contactsim.study.run import Run
from contactsim.study.stages import STAGES, stage_digest

T = TypeVar("T")
ByWildcards = Callable[[Wildcards], Any]


@dataclass(frozen=True)
class RunJobs:
    """The jobs of studies: one a run, and one a study that gathers its runs."""

    plan: Plan

    def run(self, wildcards: Wildcards) -> Run:
        """Return the run that a job simulates."""
        return self.plan.run(wildcards.study, wildcards.variant, wildcards.member)

    def params(self, wildcards: Wildcards) -> str:
        """Return what the results of a run depend on."""
        run = self.run(wildcards)
        return canonical({"settings": run.settings, "source": run.source, "module": STAGES[run.stage][0]})

    def label(self, wildcards: Wildcards) -> str:
        """Return the coordinates of a run in words."""
        run = self.run(wildcards)
        coordinates = [f"{name} {value}" for name, value in run.coordinates.items() if name != "points"]
        return " ".join(["", *coordinates, f"on {run.settings['points']} points"])

    def decision(self, wildcards: Wildcards) -> Path | list[Path]:
        """Return the file that says which effects a run neglects; nothing where it neglects none by itself."""
        return self.plan.decision(self.run(wildcards)) or []

    def twin(self, wildcards: Wildcards) -> Path | list[Path]:
        """Return the dataset of an earlier run that may be the same; nothing where there is none."""
        return self.plan.twin(self.run(wildcards)) or []

    def costs(self, wildcards: Wildcards) -> Path:
        """Return the file of what a run cost."""
        return self.plan.results / f"costs/runs/{self.run(wildcards).stem}.json"

    def memory(self, wildcards: Wildcards, attempt: int) -> int:
        """Return the megabytes that a run asks of a cluster."""
        from contactsim.evaluation import resources

        return resources.request_memory(self.run(wildcards), self.costs(wildcards), attempt)

    def minutes(self, wildcards: Wildcards, attempt: int) -> int:
        """Return the minutes that a run asks of a cluster."""
        from contactsim.evaluation import resources

        return resources.request_minutes(self.run(wildcards), self.costs(wildcards), attempt)

    def is_short(self, wildcards: Wildcards) -> bool:
        """Return True where a run should share a job of a cluster with others."""
        from contactsim.evaluation import resources

        return resources.is_short(self.run(wildcards), self.costs(wildcards))

    def selection_params(self, wildcards: Wildcards) -> str:
        """Return what the selection of effects depends on."""
        return canonical(self.plan.decision_settings(wildcards.study, wildcards.variant))

    def study_params(self, wildcards: Wildcards) -> str:
        """Return what the dataset of a study depends on."""
        return canonical(self.plan.study_settings(wildcards.study))

    def study_files(self, folder: str, ending: str) -> ByWildcards:
        """Return a function for the files of all runs of a study, in a folder and with an ending."""

        def files(wildcards: Wildcards) -> list[Path]:
            runs = self.plan.studies[wildcards.study].runs()
            return [self.plan.results / folder / f"{run.stem}.{ending}" for run in runs]

        return files

    def predict(self, jobs: Iterable[Any], cores: int) -> str:
        """Tell the logger how long each job of Snakemake will take; return in words how long all take together."""
        from contactsim.evaluation import resources

        runs, others, predictions = [], [], {}
        for job in jobs:
            if job.rule.name != "simulate_member":
                seconds = resources.predict_other_job(job.rule.name) if job.output else 0.0
                others += [seconds] if job.output else []
            elif self.plan.twin(self.run(job.wildcards)) is None:
                seconds = resources.predict_run(self.run(job.wildcards), self.costs(job.wildcards))
                runs.append(seconds)
            else:
                seconds = resources.START_SECONDS
            predictions[job.jobid] = job.rule.name, seconds
        snakemake_logger_plugin_progress.predict(predictions)
        return resources.summarise_jobs(runs, others, cores)


@dataclass(frozen=True)
class ResultJobs:
    """The jobs of figures and claims, from the datasets of studies."""

    plan: Plan

    def figure_params(self, name: str) -> ByWildcards:
        """Return a function for what a figure depends on."""
        return lambda wildcards: canonical(self.plan.figure_settings(name))

    def claims_data(self, wildcards: Wildcards) -> list[Path]:
        """Return the datasets that a chapter's claims are about."""
        studies = self.plan.claims_studies(wildcards.chapter)
        return [self.plan.results / f"datasets/{self.plan.dataset_name(study)}.nc" for study in studies]

    def claims_costs(self, wildcards: Wildcards) -> list[Path]:
        """Return the tables of costs that a chapter's claims are about."""
        studies = self.plan.claims_costs(wildcards.chapter)
        return [self.plan.results / f"costs/{self.plan.dataset_name(study)}.csv" for study in studies]

    def claims_params(self, wildcards: Wildcards) -> str:
        """Return what the verdicts on a chapter's claims depend on."""
        return canonical(self.plan.claims_settings(wildcards.chapter))


@dataclass(frozen=True)
class EvaluationJobs:
    """The jobs that evaluate the package: work–precision, robustness, effects, trials and maps."""

    products: Products

    def case_params(self, wildcards: Wildcards) -> str:
        """Return what the errors of a solver in a work–precision case depend on."""
        return canonical(cases.case_job(self.products.cases[wildcards.case], wildcards.job))

    def case_files(self, folder: str, ending: str) -> ByWildcards:
        """Return a function for the files of the measured jobs of a case, in a folder and with an ending."""

        def files(wildcards: Wildcards) -> list[Path]:
            jobs = self.products.cases[wildcards.case].jobs()
            return [self.products.results / folder / f"{wildcards.case}/{job}.{ending}" for job in jobs]

        return files

    def case_study(self, wildcards: Wildcards) -> Path:
        """Return the dataset of the study that a case is about."""
        study = self.products.cases[wildcards.case].study.name
        return self.products.dataset(self.products.plan.dataset_name(study))

    def case_study_costs(self, wildcards: Wildcards) -> Path:
        """Return the costs of the study that a case is about."""
        study = self.products.cases[wildcards.case].study.name
        return self.products.cost_table(self.products.plan.dataset_name(study))

    def case_figure_params(self, wildcards: Wildcards) -> str:
        """Return what the figure of a case depends on."""
        case = self.products.cases[wildcards.case]
        return canonical(case_config.case_figure_job(case, self.products.plan, self.products.all_tiers))

    def overview_params(self, wildcards: Wildcards) -> str:
        """Return what the figure of all cases depends on."""
        overview, cases = _present(self.products.overview), self.products.cases
        return canonical(case_config.overview_figure_job(overview, cases, self.products.plan.tier))

    def price_params(self, wildcards: Wildcards) -> str:
        """Return what the prices of accuracy of a scene depend on."""
        return canonical(prices.price_job(_present(self.products.prices), wildcards.scene))

    def price_files(self, folder: str, ending: str) -> list[Path]:
        """Return the files of all priced scenes, in a folder and with an ending."""
        scenes = _present(self.products.prices).scenes
        return [self.products.results / folder / f"{scene}.{ending}" for scene in scenes]

    def prices_figure_params(self, wildcards: Wildcards) -> str:
        """Return what the figure of the prices of accuracy depends on."""
        return canonical(prices.prices_figure_job(_present(self.products.prices), self.products.plan.tier))

    def hazard_params(self, wildcards: Wildcards) -> str:
        """Return what the survey of a hazard depends on."""
        return canonical(hazard_survey.hazard_job(_present(self.products.hazards), wildcards.hazard))

    def hazard_files(self) -> list[Path]:
        """Return the surveys of all hazards."""
        hazards = _present(self.products.hazards).hazards
        return [self.products.results / f"stability/{hazard}.nc" for hazard in hazards]

    def robustness_params(self, wildcards: Wildcards) -> str:
        """Return what the dataset of all hazards depends on."""
        return canonical(hazard_survey.robustness_job(_present(self.products.hazards), self.products.plan))

    def survey_figure_params(self, figure: str) -> ByWildcards:
        """Return a function for what a figure of all hazards depends on."""

        def params(wildcards: Wildcards) -> str:
            hazards = _present(self.products.hazards)
            return canonical(hazard_survey.FIGURE_JOBS[figure](hazards, self.products.plan))

        return params

    def effects_params(self, wildcards: Wildcards) -> str:
        """Return what the measured costs of effects depend on."""
        return canonical(effect_cost.effects_job(_present(self.products.effects)))

    def effects_figure_params(self, wildcards: Wildcards) -> str:
        """Return what the figure of the costs of effects depends on."""
        return canonical(effect_cost.effects_figure_job(_present(self.products.effects), self.products.plan.tier))

    def trial_params(self, wildcards: Wildcards) -> str:
        """Return what one trial depends on."""
        trials = _present(self.products.trials)
        return canonical(calibration.trial_job(trials, trials.trial, "trial", wildcards.kind, int(wildcards.number)))

    def trial_files(self, folder: str, ending: str) -> list[Path]:
        """Return the files of all trials, in a folder and with an ending."""
        trials = _present(self.products.trials)
        return [self.products.results / folder / f"{name}.{ending}" for name in trials.names(trials.trial)]

    def trials_figure_params(self, wildcards: Wildcards) -> str:
        """Return what the figure of all trials depends on."""
        return canonical(calibration.trials_figure_job(_present(self.products.trials), self.products.plan.tier))

    def scaling_params(self, wildcards: Wildcards) -> str:
        """Return what the measurement of one scene for the fit depends on."""
        trials, kind = _present(self.products.trials), wildcards.kind
        return canonical(
            calibration.trial_job(trials, trials.calibration, "measure_scaling", kind, int(wildcards.number))
        )

    def scaling_files(self, wildcards: Wildcards) -> list[Path]:
        """Return the measurements of all scenes for the fit."""
        trials = _present(self.products.trials)
        return [self.products.results / f"costs/relations/{name}.csv" for name in trials.names(trials.calibration)]

    def map_params(self, wildcards: Wildcards) -> str:
        """Return what one map of neglected effects depends on."""
        return canonical(effect_survey.map_job(_present(self.products.maps), wildcards.map))

    def map_files(self) -> list[Path]:
        """Return all maps of neglected effects."""
        names = sorted(_present(self.products.maps).maps)
        return [self.products.results / f"effect_maps/{name}.nc" for name in names]

    def maps_figure_params(self, wildcards: Wildcards) -> str:
        """Return what the figure of all maps depends on."""
        return canonical(effect_survey.maps_figure_job(_present(self.products.maps), self.products.plan.tier))

    def maps_params(self, wildcards: Wildcards) -> str:
        """Return the settings of all maps."""
        return canonical(_present(self.products.maps).settings)

    def full_tier(self, wildcards: Wildcards) -> list[Path]:
        """Return no file; exit at a tier that shortens trials or maps."""
        plan = self.products.plan
        if plan.overrides["trials"] or plan.overrides["effect_maps"]:
            sys.exit(f"Error: tier: got {plan.tier}; allowed: one that shortens no trials and maps, such as standard")
        return []


def _present(settings: T | None) -> T:
    """Return settings that exist: the rules that ask for them do not, where a folder lacks their file."""
    assert settings is not None
    return settings


def code_digest(stage: str) -> ByWildcards:
    """Return a function for the digest of the code of a stage of `contactsim.study.stages`."""
    return lambda wildcards: stage_digest(stage)


def group_on_cluster(workflow: Any, name: str, condition: Callable[[Wildcards], bool] | None = None) -> ByWildcards:
    """Return a function for the group of jobs that share a job of a cluster; None in local and dry runs.

    condition: which jobs of the rule belong to the group; all where there is none.
    """

    def group(wildcards: Wildcards) -> str | None:
        belongs = workflow.non_local_exec and (condition is None or condition(wildcards))
        return name if belongs else None

    return group


def timed_threads(plan: Plan, cores: int, at_once: int = 1) -> int:
    """Return the cores that a timed job keeps from others: all, or a share where `at_once` may run together.

    The job itself computes on one core.
    """
    return -(-cores // at_once) if plan.timed_alone else 1
