"""What shows all results together: the list of targets, the report, the gallery and the bundle to deposit."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path

from products import Products
from snakemake.iocontainers import Wildcards

from contactsim.code_digest import source_digest
from contactsim.evaluation.calibration.settings import trials_figure_job
from contactsim.evaluation.effects import effect_cost
from contactsim.evaluation.robustness import survey
from contactsim.provenance import canonical, digest

PROJECT_FILES = ["CITATION.cff", "LICENSE", "environment.txt", "environment.lock.txt", "Snakefile"]
"""Files of the project that the bundle holds, beside the settings and the folder of the workflow."""
EXAMPLE, ANALYSED = "examples/reanalyse.py", {"ch3_rough_line", "ch5_rough_adhesive"}
"""An example that the bundle holds with the datasets that it analyses."""


@dataclass(frozen=True)
class Pages:
    """The list of targets, and what the report, the gallery and the bundle are made of."""

    products: Products

    def target_lines(self) -> str:
        """Return a line on each target."""
        plan, cases = self.products.plan, self.products.cases
        titles = {name: figure.settings["title"] for name, figure in plan.figures.items()}
        titles |= {name: f"dataset: {study.settings['title']}" for name, study in plan.studies.items()}
        titles |= self.products.evaluation_titles
        titles |= {"accuracy": "all targets accuracy_NAME: error against cost of every solver"} if cases else {}
        titles |= {"claims": "statements of the thesis, with verdicts"} if plan.claims else {}
        titles |= {
            "report": "all results on one page",
            "all": "all targets above; not included are:",
            "gallery": "small pictures of all figures, with verdicts, errors and costs",
            "bundle": "all results in one folder to publish",
        }
        width = max(map(len, titles))
        return "\n".join(f"  {name:{width}}  {title}" for name, title in titles.items())

    def list_targets(self, wildcards: Wildcards) -> Path:
        """Print the targets; return a file that is there, as input of a rule that makes nothing."""
        hint = "another: make TARGET TIER=NAME, or --config tier=NAME"
        print(f"Targets (tier {self.products.plan.tier}; {hint}):\n{self.target_lines()}")
        return self.products.config / "config.yaml"

    def refuse_target(self, wildcards: Wildcards) -> None:
        """Exit with the list of targets, since the one that was asked for does not exist."""
        name, lines = str(wildcards.name), self.target_lines()
        if "=" in name:
            sys.exit(
                f"Error: {name!r} is no target. A tier is chosen so: make TARGET TIER=quick, or --config tier=quick"
            )
        names = [line.split()[0] for line in lines.splitlines()]
        near = get_close_matches(name.replace(".", "_"), names, 1)
        hint = f"Error: there is no target {name!r}" + (f"; did you mean {near[0]}?" if near else "")
        sys.exit(f"{hint}\nThere are:\n{lines}")

    def report_inputs(self) -> list[Path]:
        """Return the files that the report and the gallery show."""
        pictures = [file for file in self.products.all_figures() if file.suffix == ".png"]
        return self.products.study_files() + pictures + self.products.all_claims()

    def report_params(self, wildcards: Wildcards) -> str:
        """Return what the report depends on beside its files."""
        from contactsim.publish import report

        return canonical(report.report_settings(self.products.plan, self.products.evaluation_figures))

    def gallery_params(self, wildcards: Wildcards) -> str:
        """Return what the gallery depends on beside its files."""
        from contactsim.publish import gallery

        return canonical(gallery.gallery_settings(self.products.plan, self.products.evaluation_titles))

    def bundle_places(self) -> dict[str, Path]:
        """Return the files of the bundle by their places in it."""
        products, root = self.products, self.products.config.parent
        results = [products.dataset(name) for name in (*products.study_datasets, *products.evaluation_datasets)]
        results += [products.cost_table(name) for name in products.study_datasets]
        results += [products.results / "report.html"]
        results += [products.results / f"figures/accuracy_{case}_at_equal_error.csv" for case in products.cases]
        results += products.all_figures() + products.all_claims()
        project = [root / name for name in PROJECT_FILES]
        project += [root / EXAMPLE] if set(products.study_datasets) >= ANALYSED else []
        project += sorted([*products.config.glob("*.yaml"), *products.config.glob("*.md")])
        project += sorted(file for ending in ("smk", "py") for file in (root / "workflow").rglob(f"*.{ending}"))
        places = {str(file.relative_to(products.results)): file for file in results}
        return places | {str(file.relative_to(root)): file for file in project}

    def bundle_files(self, wildcards: Wildcards) -> list[Path]:
        """Return the files of the bundle."""
        return list(self.bundle_places().values())

    def bundle_params(self, wildcards: Wildcards) -> str:
        """Return what the bundle depends on beside its files."""
        products, plan, places = self.products, self.products.plan, self.bundle_places()
        project = {
            place: file.read_text(encoding="utf-8")
            for place, file in places.items()
            if products.results not in file.parents
        }
        figures = [plan.figure_settings(name) for name in plan.figures]
        claims = [plan.claims_settings(chapter) for chapter in plan.claims]
        return canonical(
            {
                "tier": plan.tier,
                "titles": self._titles(),
                "files": list(places),
                "data": {name: digest(settings) for name, settings in self._data_settings().items()},
                "shown": digest((figures, claims)),
                "project": digest(project),
                "source": source_digest("contactsim.publish.bundle", "contactsim.publish.job_list"),
            }
        )

    def _titles(self) -> dict[str, str]:
        """Return the titles of all figures and datasets by name."""
        plan = self.products.plan
        titles = {name: figure.settings["title"] for name, figure in plan.figures.items()}
        titles |= {plan.dataset_name(name): study.settings["title"] for name, study in plan.studies.items()}
        return titles | self.products.evaluation_titles

    def _data_settings(self) -> dict[str, object]:
        """Return what each dataset depends on, by name."""
        products, plan = self.products, self.products.plan
        data: dict[str, object] = {plan.dataset_name(name): plan.study_settings(name) for name in plan.studies}
        if products.hazards:
            data["stability"] = survey.robustness_job(products.hazards, plan)
        if products.effects:
            data["effects"] = effect_cost.effects_job(products.effects)
        if products.trials:
            data["trials"] = trials_figure_job(products.trials, plan.tier)
        return data
