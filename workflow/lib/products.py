"""What one tier can make: studies, figures and claims of the chapters, and the evaluation of the package itself."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from contactsim.errors import InputError
from contactsim.evaluation.calibration import settings as calibration
from contactsim.evaluation.effects import effect_cost, map_settings
from contactsim.evaluation.figure_settings import FigureSettings
from contactsim.evaluation.identification import settings as identification_settings
from contactsim.evaluation.robustness import survey
from contactsim.evaluation.work_precision import case_config
from contactsim.evaluation.work_precision.cases import Case
from contactsim.evaluation.work_precision.prices import Prices, read_prices
from contactsim.study.figure_plan import PICTURE_ENDINGS
from contactsim.study.plan import Plan


@dataclass(frozen=True)
class Products:
    """The plan of a tier, and the settings of what evaluates the package; None where there are none.

    Parameters
    ----------
    config
        Folder with the YAML files.
    plan
        Studies, figures and claims.
    cases
        Cases of the work–precision study by name.
    hazards
        The survey of robustness.
    effects
        The costs of effects.
    prices
        Scenes solved to smaller and smaller errors.
    trials
        Scenes drawn at random and solved to an accuracy.
    maps
        What neglecting effects changes.
    overview
        The page of all cases.
    identification
        Candidates for what Chapter 6 leaves open.
    """

    config: Path
    plan: Plan
    cases: dict[str, Case]
    hazards: survey.Robustness | None
    effects: effect_cost.EffectCosts | None
    prices: Prices | None
    trials: calibration.Trials | None
    maps: map_settings.EffectMaps | None
    overview: FigureSettings | None
    identification: identification_settings.Identification | None

    @classmethod
    def read(cls, config: Path, options: Mapping[str, object]) -> Products:
        """Read all settings and check them.

        Parameters
        ----------
        config
            Folder with the YAML files.
        options
            What was given to `--config`: `tier` or nothing.

        Raises
        ------
        InputError
            Where a key or value is wrong.
        """
        unknown = [str(name) for name in options if name != "tier"]
        if unknown:
            raise InputError("--config", sorted(unknown), "tier=NAME, of tiers.yaml")
        for value in options.values():
            if not isinstance(value, str):
                raise InputError("--config tier", value, "tier=NAME, of tiers.yaml")
        plan = Plan.read(config, options.get("tier"))
        cases = case_config.read_cases(config, plan)
        return cls(
            config,
            plan,
            cases,
            hazards=survey.read_robustness(config, plan),
            effects=effect_cost.read_variants(config, plan.seed, plan.overrides["effects"], plan.tier),
            prices=read_prices(config, plan),
            trials=calibration.read_trials(config, plan.overrides["trials"], plan.tier),
            maps=map_settings.read_maps(config, plan.overrides["effect_maps"], plan.tier),
            overview=case_config.read_overview(config) if cases else None,
            identification=identification_settings.read_identification(config, plan),
        )

    @property
    def results(self) -> Path:
        """Return the folder of the tier's results."""
        return self.plan.results

    @functools.cached_property
    def all_tiers(self) -> dict[str, Plan]:
        """Return the plans of all tiers by name."""
        return case_config.read_all_tiers(self.config, self.plan)

    @functools.cached_property
    def evaluation_figures(self) -> dict[str, dict[str, FigureSettings]]:
        """Return the settings of the figures that evaluate the package, by section of the report and by name."""
        cases: dict[str, FigureSettings] = {f"accuracy_{name}": case.settings for name, case in self.cases.items()}
        return {
            "accuracy": _present(price_of_accuracy=self.prices)
            | cases
            | _present(trials=self.trials, overview=self.overview),
            "stability": _present(robustness=self.hazards and self.hazards.families, stability=self.hazards),
            "effects": _present(effects=self.effects, effect_maps=self.maps),
            "identification": _present(identification=self.identification),
        }

    @property
    def evaluation_titles(self) -> dict[str, str]:
        """Return the titles of the figures that evaluate the package, by name."""
        figures = self.evaluation_figures.values()
        return {name: figure.title for section in figures for name, figure in section.items()}

    @property
    def evaluation_datasets(self) -> list[str]:
        """Return the names of the datasets that evaluate the package."""
        return list(_present(stability=self.hazards, effects=self.effects, trials=self.trials))

    @property
    def study_datasets(self) -> list[str]:
        """Return the names of the datasets of all studies."""
        return [self.plan.dataset_name(study) for study in self.plan.studies]

    def dataset(self, name: str) -> Path:
        """Return the file of a dataset."""
        return self.results / "datasets" / f"{name}.nc"

    def cost_table(self, name: str) -> Path:
        """Return the file of what a study's runs cost."""
        return self.results / "costs" / f"{name}.csv"

    def figure_files(self, name: str) -> list[Path]:
        """Return the files of a figure: picture, document, numbers, and an animation where there is one."""
        figures = self.plan.figures
        endings = figures[name].endings if name in figures else PICTURE_ENDINGS
        return [self.results / "figures" / f"{name}.{ending}" for ending in endings]

    def all_figures(self) -> list[Path]:
        """Return the files of all figures."""
        return [file for name in (*self.plan.figures, *self.evaluation_titles) for file in self.figure_files(name)]

    def all_claims(self) -> list[Path]:
        """Return the files of the verdicts on all chapters' claims."""
        folder, chapters = self.results / "claims", self.plan.claims
        return [folder / f"{chapter}.{ending}" for chapter in chapters for ending in PICTURE_ENDINGS]

    def study_files(self) -> list[Path]:
        """Return the datasets of all studies, each with its table of costs."""
        return [file for name in self.study_datasets for file in (self.dataset(name), self.cost_table(name))]


def _present(**settings: FigureSettings | None) -> dict[str, FigureSettings]:
    """Return the settings that are not left out, by name."""
    return {name: value for name, value in settings.items() if value}
