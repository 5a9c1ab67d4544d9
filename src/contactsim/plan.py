"""The plan: all of the config read once, and the tables of studies and figures that the workflow is built from."""

from __future__ import annotations

import ast
from dataclasses import dataclass
from pathlib import Path

from contactsim import stability
from contactsim.config import Key, load_yaml, mapping, overlaid, pair, read, size, text, whole
from contactsim.errors import SceneError
from contactsim.provenance import digest, module_path, source_digest
from contactsim.study import Run, Study

CONFIG_KEYS = {
    "seed": Key(whole(0), "a whole number, 0 or more"),
    "tier": Key(text, "the name of a tier in tiers.yaml"),
    "results": Key(text, "a folder for all results"),
}
TIER_KEYS = {
    "studies": Key(mapping, "a mapping", {}),
    "stability": Key(mapping, "a mapping of keys to override", {}),
}
CHAPTER_KEYS = {
    "studies": Key(mapping, "a mapping from names to studies"),
    "figures": Key(mapping, "a mapping from names to figures"),
}


def limits(value: object) -> list[float]:
    """Two numbers, the least first."""
    if pair(value) != sorted(pair(value)):
        raise ValueError
    return pair(value)


FIGURE_KEYS = {
    "study": Key(text, "the name of a study of this chapter"),
    "title": Key(text, "a line of text"),
    "caption": Key(text, "text"),
    "size": Key(size, "width and height in inches"),
    "panels": Key(whole(1), "number of axes side by side", 1),
    "select": Key(mapping, "a mapping from a dimension to its least and largest value shown", {}),
    "reference": Key(mapping, "a mapping from names to values of the thesis", {}),
}


@dataclass(frozen=True)
class Figure:
    """One figure: name, chapter, and its settings as read."""

    name: str
    chapter: str
    settings: dict


@dataclass(frozen=True)
class Plan:
    """Everything that can be made at one tier: studies and figures by name, and the map of stability if asked for.

    results: the folder for it.
    """

    tier: str
    results: Path
    studies: dict[str, Study]
    chapters: dict[str, str]
    figures: dict[str, Figure]
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
        studies, chapters, figures = {}, {}, {}
        for file in sorted(folder.glob("ch*.yaml")):
            sections = read(load_yaml(file), CHAPTER_KEYS, file)
            for name, section in sections["studies"].items():
                if name in studies:
                    raise SceneError(f"studies.{name}", name, f"a name that {chapters[name]}.yaml has not taken", file)
                over = overrides["studies"].pop(name, {})
                if not isinstance(over, dict):
                    raise SceneError(
                        f"{tier}.studies.{name}", over, "a mapping of keys to override", folder / "tiers.yaml"
                    )
                source = file if not over else f"{file} with tier {tier} of {folder / 'tiers.yaml'}"
                section = overlaid(section, over) if isinstance(section, dict) else section
                studies[name] = Study.read(name, section, source, main["seed"])
                chapters[name] = file.stem
            for name, section in sections["figures"].items():
                if name in figures:
                    raise SceneError(f"figures.{name}", name, "a name that no other chapter has taken", file)
                figures[name] = _figure(name, section, file, {study: studies[study] for study in sections["studies"]})
        for name in overrides["studies"]:
            raise SceneError(
                f"{tier}.studies.{name}", "overrides", f"one of {', '.join(studies)}", folder / "tiers.yaml"
            )
        hazards = _stability(folder, overrides["stability"], tier)
        return cls(tier, Path(main["results"]) / tier, studies, chapters, figures, hazards)

    def run(self, study: str, variant: str, member: str) -> Run:
        """The run that a file name stands for."""
        runs = {(run.variant, str(run.member)): run for run in self.studies[study].runs()}
        return runs[variant, member]

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
                "digest": run.digest,
            }
            for run in self.studies[study].runs()
        ]
        settings = self.studies[study].settings | {"name": study, "tier": self.tier, "seed": self.studies[study].seed}
        return {"runs": runs, "settings": settings, "source": source_digest("contactsim.aggregate", "contactsim.costs")}

    def hazard_settings(self, hazard: str) -> dict:
        """What the cells of one hazard depend on."""
        return stability.job_settings(self.stability, hazard)

    def map_settings(self) -> dict:
        """What the map of all hazards depends on."""
        jobs = [self.hazard_settings(hazard) for hazard in self.stability["hazards"]]
        paths = [f"{self.results}/stability/{hazard}.nc" for hazard in self.stability["hazards"]]
        settings = {key: self.stability[key] for key in ("title", "severities", "solvers", "hazards")}
        source = source_digest("contactsim.stability")
        return {"paths": paths, "jobs": jobs, "settings": settings | {"tier": self.tier}, "source": source}

    def map_figure(self) -> dict:
        """What the figure of the map depends on; in the form of `figure_settings`."""
        layout = {"panels": 2, "select": {}, "reference": {}}
        settings = {key: self.stability[key] for key in ("title", "caption", "size")} | layout
        code = source_digest("contactsim.figures.stability", "contactsim.figures.render")
        data = digest(self.map_settings())
        return {"name": "stability", "chapter": "stability", "settings": settings, "source": code, "data": data}

    def figure_settings(self, name: str) -> dict:
        """What a figure depends on: its settings, its code, and all that its data depend on."""
        figure = self.figures[name]
        code = source_digest(f"contactsim.figures.{figure.chapter}", "contactsim.figures.render")
        data = digest(self.study_settings(figure.settings["study"]))
        return {"name": name, "chapter": figure.chapter, "settings": figure.settings, "source": code, "data": data}


def _stability(folder: Path, over: dict, tier: str) -> dict | None:
    """Settings of the map of stability; None where the folder has none."""
    file = folder / "stability.yaml"
    if not file.exists():
        if over:
            raise SceneError(f"{tier}.stability", over, f"none, as there is no {file}", folder / "tiers.yaml")
        return None
    source = file if not over else f"{file} with tier {tier} of {folder / 'tiers.yaml'}"
    return stability.read_settings(overlaid(load_yaml(file), over), source)


def _figure(name: str, section: object, file: Path, studies: dict) -> Figure:
    prefix = f"figures.{name}"
    settings = read(section, FIGURE_KEYS, file, prefix)
    if settings["study"] not in studies:
        raise SceneError(f"{prefix}.study", settings["study"], f"one of {', '.join(studies)}", file)
    dims = studies[settings["study"]].dimensions
    read(
        settings["select"], dict.fromkeys(dims, Key(limits, "least and largest value", None)), file, f"{prefix}.select"
    )
    known = _functions(f"contactsim.figures.{file.stem}")
    if name not in known:
        raise SceneError(prefix, name, f"a function of contactsim.figures.{file.stem}: {', '.join(known)}", file)
    return Figure(name, file.stem, settings)


def _functions(module: str) -> list[str]:
    path = module_path(module)
    tree = ast.parse(path.read_text(encoding="utf-8")) if path else ast.Module([], [])
    return [node.name for node in tree.body if isinstance(node, ast.FunctionDef) and not node.name.startswith("_")]
