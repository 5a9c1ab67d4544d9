"""The plan: all of the config read once, and the tables of studies, figures and claims that make the workflow."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from contactsim.error_control import neglect
from contactsim.error_control.effect_maps import reduced
from contactsim.errors import SceneError
from contactsim.evaluation.robustness import survey
from contactsim.provenance import digest, source_digest
from contactsim.study.claim_plan import Claim, read_claim
from contactsim.study.figure_plan import Figure, read_figure
from contactsim.study.reading import Key, load_yaml, mapping, named, overlaid, read, text, tiered, whole
from contactsim.study.study import Run, Study

CONFIG_KEYS = {
    "seed": Key(whole(0), "a whole number, 0 or more"),
    "tier": Key(text, "the name of a tier in tiers.yaml"),
    "results": Key(text, "a folder for all results"),
}
RESERVED = """
all claims accuracy effects measure_effects trial trials relations measure_relations decide overview effect_maps
measure_map freeze_maps stability report gallery bundle targets run aggregate unknown_target price accuracy_figure
judge hazard stability_dataset test setup help
""".split()
"""Names that the workflow's own rules and the Makefile's targets have."""


def yes_or_no(value: object) -> bool:
    """True or false."""
    if not isinstance(value, bool):
        raise ValueError
    return value


TIER_KEYS = {
    "studies": Key(mapping, "a mapping", {}),
    "stability": Key(mapping, "a mapping of keys to override", {}),
    "effects": Key(mapping, "a mapping of keys to override", {}),
    "trials": Key(mapping, "a mapping of keys to override", {}),
    "effect_maps": Key(mapping, "a mapping of keys to override", {}),
    "timed_alone": Key(yes_or_no, "true or false", True),
}
CHAPTER_KEYS = {
    "studies": Key(mapping, "a mapping from names to studies", {}),
    "figures": Key(mapping, "a mapping from names to figures"),
    "claims": Key(mapping, "a mapping from names to claims", {}),
}


@dataclass(frozen=True)
class Plan:
    """All that can be made at one tier: studies, figures, claims by chapter, and the map of stability if there is one.

    results: the folder for it; seed: root of all random numbers; effects, trials, effect_maps: what the tier changes in
    the ladder of effects, the scenes drawn at random and the maps of what effects change; timed_alone: whether what is
    timed keeps cores from all else.
    """

    tier: str
    results: Path
    seed: int
    effects: dict
    trials: dict
    effect_maps: dict
    timed_alone: bool
    studies: dict[str, Study]
    chapters: dict[str, str]
    figures: dict[str, Figure]
    claims: dict[str, dict[str, Claim]]
    stability: dict | None

    @classmethod
    def read(cls, folder: str | Path, tier: str | None = None) -> Plan:
        """Read config.yaml, tiers.yaml and every chapter; `tier` overrides the one in config.yaml."""
        folder = Path(folder)
        main = read(load_yaml(folder / "config.yaml"), CONFIG_KEYS, folder / "config.yaml")
        tiers = load_yaml(folder / "tiers.yaml")
        tier = main["tier"] if tier is None else tier
        if tier not in tiers:
            raise SceneError("tier", tier, f"one of {', '.join(tiers)}", folder / "tiers.yaml")
        overrides = read(tiers[tier] or {}, TIER_KEYS, folder / "tiers.yaml", tier)
        studies, chapters, figures, claims = {}, {}, {}, {}
        for file in sorted(folder.glob("ch*.yaml")):
            sections = read(load_yaml(file), CHAPTER_KEYS, file)
            for name, section in sections["studies"].items():
                if not re.fullmatch("[A-Za-z0-9_]+", str(name)) or name in (*RESERVED, *sections["figures"]):
                    allowed = f"letters, digits and underscores; no figure's name and none of {', '.join(RESERVED)}"
                    raise SceneError("studies", name, allowed, file)
                if name in studies:
                    raise SceneError(f"studies.{name}", name, f"a name that {chapters[name]}.yaml has not taken", file)
                over = overrides["studies"].pop(name, {})
                if not isinstance(over, dict):
                    raise SceneError(
                        f"{tier}.studies.{name}", over, "a mapping of keys to override", folder / "tiers.yaml"
                    )
                if over:
                    Study.read(name, section, file, main["seed"])  # what a tier hides must be right too
                    section = overlaid(section, over)
                studies[name] = Study.read(name, section, named(file, over, tier), main["seed"])
                chapters[name] = file.stem
            own = {name: studies[name] for name in sections["studies"]}
            _check_surfaces(own)
            for name, section in sections["figures"].items():
                if name in figures:
                    raise SceneError(f"figures.{name}", name, "a name that no other chapter has taken", file)
                figures[name] = read_figure(name, section, file, own)
            if sections["claims"]:
                claims[file.stem] = {
                    name: read_claim(name, section, file, own) for name, section in sections["claims"].items()
                }
        for name in overrides["studies"]:
            raise SceneError(
                f"{tier}.studies.{name}", "overrides", f"one of {', '.join(studies)}", folder / "tiers.yaml"
            )
        hazards = tiered(folder / "stability.yaml", overrides["stability"], tier)
        paths = (
            Path(main["results"]) / tier,
            main["seed"],
            overrides["effects"],
            overrides["trials"],
            overrides["effect_maps"],
            overrides["timed_alone"],
        )
        return cls(tier, *paths, studies, chapters, figures, claims, hazards and survey.read_settings(*hazards))

    def run(self, study: str, variant: str, member: str) -> Run:
        """The run that a file name stands for."""
        runs = {(run.variant, str(run.member)): run for run in self.studies[study].runs()}
        return runs[variant, member]

    def decision(self, run: Run) -> Path | None:
        """The file that says what is negligible in a run; none where nothing is to be left out by itself."""
        if "auto" not in run.settings:
            return None
        runs = self.studies[run.study].runs()  # one that measures an error does as the runs that it measures it of
        same = next(one for one in runs if one.coordinates == run.coordinates)
        return self.results / f"decisions/{run.study}/{same.variant}.json"

    def twin(self, run: Run) -> Path | None:
        """The dataset of an earlier run that is expected to be the same without what is negligible, if there is one."""
        other = self._twins.get(run.stem)
        return None if other is None else self.results / f"runs/{other.stem}.nc"

    @cached_property
    def _twins(self) -> dict[str, Run]:
        """By name of a run, the first of its study and member whose scene is the same without what is negligible."""
        found, first = {}, {}
        for study in self.studies.values():
            for run in study.runs() if study.settings["auto"] else ():
                if "auto" in run.settings:
                    left = neglect.foreseen(run.settings, study.settings["auto"]["within"])
                    key = study.name, run.member, run.error, reduced(run.settings | {"leave_out": left})
                    if left and first.setdefault(key, run) is not run:
                        found[run.stem] = first[key]
        return found

    def decision_settings(self, study: str, variant: str) -> dict:
        """What a decision on what is negligible depends on."""
        run = self.run(study, variant, "0")
        return {"settings": run.settings, "source": digest(run.source, neglect.source())}

    def dataset_name(self, study: str) -> str:
        """File name of a study's dataset, without ending."""
        return f"{self.chapters[study]}_{study}"

    def study_settings(self, study: str) -> dict:
        """What the aggregation of a study depends on: its settings, and every run's place and digest."""
        runs = [
            {
                "path": f"{self.results}/runs/{run.stem}.nc",
                "costs": f"{self.results}/costs/runs/{run.stem}.json",
                "coordinates": run.coordinates,
                "member": run.member,
                "companion": run.companion,
                "error": run.error,
                "digest": run.digest,
            }
            for run in self.studies[study].runs()
        ]
        settings = self.studies[study].settings | {"name": study, "tier": self.tier, "seed": self.studies[study].seed}
        return {
            "runs": runs,
            "settings": settings,
            "source": source_digest("contactsim.analysis.aggregate", "contactsim.analysis.costs"),
        }

    def hazard_settings(self, hazard: str) -> dict:
        """What the cells of one hazard depend on."""
        return survey.job_settings(self.stability, hazard)

    def map_settings(self) -> dict:
        """What the map of all hazards depends on."""
        jobs = [self.hazard_settings(hazard) for hazard in self.stability["hazards"]]
        paths = [f"{self.results}/stability/{hazard}.nc" for hazard in self.stability["hazards"]]
        settings = {key: self.stability[key] for key in ("title", "severities", "solvers", "hazards")}
        source = source_digest("contactsim.evaluation.robustness.survey")
        return {"paths": paths, "jobs": jobs, "settings": settings | {"tier": self.tier}, "source": source}

    def map_figure(self) -> dict:
        """What the figure of the map depends on; in the form of `figure_settings`."""
        layout = {"panels": 2, "select": {}, "reference": {}, "law": None, "film": None}
        settings = {key: self.stability[key] for key in ("title", "caption", "size")} | layout
        code = source_digest("contactsim.figures.diagnostics.stability", "contactsim.figures.layout")
        data = digest(self.map_settings())
        module = "contactsim.figures.diagnostics.stability"
        return {"name": "stability", "module": module, "settings": settings, "source": code, "data": data}

    def figure_settings(self, name: str) -> dict:
        """What a figure depends on: its settings, its code, and all that its data depend on."""
        figure = self.figures[name]
        module = f"contactsim.figures.{figure.chapter}"
        code = source_digest(module, "contactsim.figures.layout")
        data = digest(*(self.study_settings(study) for study in figure.studies))
        return {"name": name, "module": module, "settings": figure.settings, "source": code, "data": data}

    def claims_studies(self, chapter: str) -> list[str]:
        """The studies that a chapter's claims ask."""
        return sorted({study for claim in self.claims[chapter].values() for study in claim.studies})

    def claims_settings(self, chapter: str) -> dict:
        """What the verdicts of a chapter depend on: its claims in their order, their code, and all their data's."""
        data = {study: digest(self.study_settings(study)) for study in self.claims_studies(chapter)}
        claims = [[name, claim.settings] for name, claim in self.claims[chapter].items()]
        code = source_digest("contactsim.analysis.claims", "contactsim.figures.diagnostics.claims")
        return {"chapter": chapter, "claims": claims, "source": code, "data": data}


RESCALED = ("hurst", "rms_height", "rms_gradient", "shortest_wavelength")
"""What leaves the random waves of a self-affine surface the same, but for their size and how many there are."""


def _check_surfaces(studies: dict[str, Study]) -> None:
    """A study that presses another's surfaces must describe them as the other does, which has its own."""
    for study in studies.values():
        name = study.settings["surfaces_of"]
        if name is None:
            continue
        other, key = studies.get(name), f"studies.{study.name}.surfaces_of"
        if other is None or other.settings["surfaces_of"] is not None:
            known = ", ".join(one for one, its in studies.items() if its.settings["surfaces_of"] is None)
            raise SceneError(key, name, f"one of {known}", study.file)
        one, two = ({k: v for k, v in its.settings["surface"].items() if k not in RESCALED} for its in (study, other))
        if one != two or one["kind"] != "self_affine":
            allowed = f"a study with the same `surface`, self_affine, but for {', '.join(RESCALED)}"
            raise SceneError(key, name, allowed, study.file)
