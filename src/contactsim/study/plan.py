"""The plan: all of the config read once, and the tables of studies, figures and claims that make the workflow."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from contactsim.analysis.costs import QUANTITIES
from contactsim.errors import InputError
from contactsim.provenance import digest
from contactsim.study.chapter import Chapter, ChapterReader
from contactsim.study.claim_plan import Claim
from contactsim.study.figure_plan import Figure
from contactsim.study.places import check_config_files, read_results
from contactsim.study.plain_yaml import load_yaml
from contactsim.study.reading import SAFE_NAME, SAFE_NAME_FORM, Key, listed, mapping, read, text, whole
from contactsim.study.reserved_names import reserved_names
from contactsim.study.run import Run
from contactsim.study.select_effects import selection_digest
from contactsim.study.shared_runs import find_runs_alike, find_twins
from contactsim.study.stages import stage_digest
from contactsim.study.study import Study

CONFIG_KEYS = {
    "seed": Key(whole(0), "a whole number, 0 or more"),
    "tier": Key(text, "the name of a tier in tiers.yaml"),
    "results": Key(text, "a folder for all results"),
    "data_folders": Key(listed(text), "a list of folders with measured heights, beside this one", []),
}


def boolean(value: object) -> bool:
    """Return the value if it is true or false."""
    if not isinstance(value, bool):
        raise ValueError
    return value


OVERRIDES = ("stability", "effects", "trials", "effect_maps", "identification", "price_of_accuracy")
"""Files beside tiers.yaml whose keys a tier can override."""
CONFIG_FILES = ("config", "tiers", "accuracy", "overview", *OVERRIDES)
"""Files of a config beside the chapters."""
TIER_KEYS = {
    "studies": Key(mapping, "a mapping", {}),
    "timed_alone": Key(boolean, "true or false", True),
} | {name: Key(mapping, "a mapping of keys to override", {}) for name in OVERRIDES}


@dataclass(frozen=True)
class Plan:
    """All that can be made at one tier.

    Parameters
    ----------
    tier : str
        Name of the tier.
    tiers : tuple of str
        Names of all tiers.
    results : Path
        Folder of its results.
    seed : int
        Root of all random numbers.
    overrides : mapping
        What the tier changes in the files of `OVERRIDES`.
    timed_alone : bool
        True where timed jobs keep cores from all else.
    studies : dict
        Studies by name.
    chapters : dict
        Chapter of each study.
    figures : dict
        Figures by name.
    claims : dict
        Claims by chapter and name.
    reserved_names : tuple of str
        Names of the workflow's rules and targets, which nothing else can have.
    """

    tier: str
    tiers: tuple[str, ...]
    results: Path
    seed: int
    overrides: Mapping[str, dict]
    timed_alone: bool
    studies: dict[str, Study]
    chapters: dict[str, str]
    figures: dict[str, Figure]
    claims: dict[str, dict[str, Claim]]
    reserved_names: tuple[str, ...]

    @classmethod
    def read(cls, folder: str | Path, tier: str | None = None) -> Plan:
        """Read config.yaml, tiers.yaml and every chapter; `tier` overrides the one in config.yaml."""
        folder = Path(folder)
        check_config_files(folder, CONFIG_FILES)
        file, project = folder / "config.yaml", folder.resolve().parent
        main = read(load_yaml(file), CONFIG_KEYS, file)
        source, tier = (file, main["tier"]) if tier is None else (None, tier)
        sections = _read_tiers(folder / "tiers.yaml")
        if tier not in sections:
            allowed = f"one of {', '.join(sections)}, the tiers of {folder / 'tiers.yaml'}"
            raise InputError("tier", tier, allowed, source)
        section = sections[tier]
        plan = cls(
            tier=tier,
            tiers=tuple(sections),
            results=read_results(main["results"], tier, project, file),
            seed=main["seed"],
            overrides={name: section[name] for name in OVERRIDES},
            timed_alone=section["timed_alone"],
            studies={},
            chapters={},
            figures={},
            claims={},
            reserved_names=reserved_names(project),
        )
        reader = ChapterReader(tier, section["studies"], plan.seed, plan.reserved_names, main["data_folders"])
        for file in sorted(folder.glob("ch*.yaml")):
            plan._add_chapter(reader.read(file), file)
        for name, study, override in ((key, *item) for key in sections for item in sections[key]["studies"].items()):
            if study not in plan.studies:
                allowed = f"no such study, but {', '.join(plan.studies)}"
                raise InputError(f"{name}.studies.{study}", override, allowed, folder / "tiers.yaml")
        return plan

    def _add_chapter(self, chapter: Chapter, file: Path) -> None:
        """Add the studies, figures and claims of a chapter; raise InputError for a name that another chapter has."""
        for name in chapter.studies:
            if name in self.studies:
                raise InputError(f"studies.{name}", name, f"a name that {self.chapters[name]}.yaml has not taken", file)
        for name in chapter.figures:
            if name in self.figures:
                raise InputError(f"figures.{name}", name, "a name that no other chapter has taken", file)
        self.studies.update(chapter.studies)
        self.chapters.update(dict.fromkeys(chapter.studies, file.stem))
        self.figures.update(chapter.figures)
        if chapter.claims:
            self.claims[file.stem] = chapter.claims

    def run(self, study: str, variant: str, member: str) -> Run:
        """Return the run that a file name stands for."""
        return self._runs[study, variant, str(member)]

    @cached_property
    def _runs(self) -> dict[tuple[str, str, str], Run]:
        """All runs by study, variant and member."""
        return {
            (name, run.variant, str(run.member)): run for name, study in self.studies.items() for run in study.runs()
        }

    def decision(self, run: Run) -> Path | None:
        """Return the file that says which effects a run neglects; None for a run that neglects none by itself."""
        if "auto" not in run.settings:
            return None
        runs = self.studies[run.study].runs()  # one that measures an error does as the runs that it measures it of
        same = next(other for other in runs if other.coordinates == run.coordinates)
        return self.results / f"decisions/{run.study}/{same.variant}.json"

    def twin(self, run: Run) -> Path | None:
        """Return the dataset of an earlier run that is expected to be the same without what is negligible, if any."""
        other = self._twins.get(run.stem)
        return None if other is None else self.results / f"runs/{other.stem}.nc"

    @cached_property
    def _twins(self) -> dict[str, Run]:
        """Twins of runs by their stems."""
        return find_twins(self.studies.values())

    @cached_property
    def runs_alike(self) -> dict[str, list[str]]:
        """Stems of the other runs of any study of whose loads some may be those of a run, by its stem."""
        return find_runs_alike(self._runs.values())

    def decision_settings(self, study: str, variant: str) -> dict:
        """Return what a decision on negligible effects depends on."""
        run = self.run(study, variant, "0")
        return {"settings": run.settings, "source": digest(run.source, selection_digest())}

    def dataset_name(self, study: str) -> str:
        """Return the file name of a study's dataset, without ending."""
        return f"{self.chapters[study]}_{study}"

    def study_settings(self, study: str) -> dict:
        """Return what the aggregation of a study depends on: its settings, and every run's place and digest."""
        runs = [
            {
                "path": f"{self.results}/runs/{run.stem}.nc",
                "costs": f"{self.results}/costs/runs/{run.stem}.json",
                "coordinates": run.coordinates,
                "member": run.member,
                "measures_error": run.measures_error,
                "error": run.error,
                "digest": run.digest,
            }
            for run in self.studies[study].runs()
        ]
        settings = self.studies[study].settings | {"name": study, "tier": self.tier, "seed": self.studies[study].seed}
        return {"runs": runs, "settings": settings, "source": stage_digest("aggregate")}

    def figure_settings(self, name: str) -> dict:
        """Return what a figure depends on: its settings, its code, and all that its data depend on."""
        figure = self.figures[name]
        code = stage_digest("figure_of_law" if figure.settings["law"] else "figure", figure.module)
        data = digest(*(self.study_digest(study) for study in figure.studies))
        return {"name": name, "module": figure.module, "settings": figure.settings, "source": code, "data": data}

    def study_digest(self, study: str) -> str:
        """Return a digest of what a study's dataset depends on."""
        if study not in self._study_digests:
            self._study_digests[study] = digest(self.study_settings(study))
        return self._study_digests[study]

    @cached_property
    def _study_digests(self) -> dict[str, str]:
        """Digests that have been made."""
        return {}

    def claims_studies(self, chapter: str) -> list[str]:
        """Return the studies whose datasets a chapter's claims read."""
        return sorted({study for claim in self.claims[chapter].values() for study in claim.studies})

    def claims_costs(self, chapter: str) -> list[str]:
        """Return the studies whose costs a chapter's claims read, too."""
        claims = [claim for claim in self.claims[chapter].values() if claim.settings.get("quantity") in QUANTITIES]
        return sorted({study for claim in claims for study in claim.studies})

    def claims_settings(self, chapter: str) -> dict:
        """Return what the verdicts of a chapter depend on: its claims in their order, their code, and their data."""
        data = {study: self.study_digest(study) for study in self.claims_studies(chapter)}
        claims = [[name, claim.settings] for name, claim in self.claims[chapter].items()]
        source, costs = stage_digest("claims", "contactsim.analysis.costs"), self.claims_costs(chapter)
        return {"chapter": chapter, "claims": claims, "source": source, "data": data, "costs": costs}


def _read_tiers(file: Path) -> dict[str, dict]:
    """Return the sections of all tiers by name."""
    tiers = load_yaml(file)
    for name in tiers:
        if not SAFE_NAME.fullmatch(name):
            raise InputError("name of a tier", name, SAFE_NAME_FORM, file)
    return {name: read({} if section is None else section, TIER_KEYS, file, name) for name, section in tiers.items()}
