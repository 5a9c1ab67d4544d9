"""The jobs of baselines: solvers compared with a study's own, whose results the package contains."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from products import Products
from snakemake.iocontainers import Wildcards

from contactsim.evaluation.work_precision import baselines
from contactsim.evaluation.work_precision.case_config import KEPT_TIERS, read_kept_tiers
from contactsim.evaluation.work_precision.cases import case_job
from contactsim.provenance import canonical
from contactsim.solvers.registry import is_installed


@dataclass(frozen=True)
class BaselineJobs:
    """The tables of baselines that the package contains, and their measurement."""

    products: Products

    @property
    def table(self) -> Path:
        """Return the table of all jobs, to replace that of the package."""
        return self.products.results / "accuracy/package" / baselines.FILE.name

    def case_tables(self) -> list[Path]:
        """Return the tables of all cases that have baselines, to replace those of the package."""
        return [baselines.table_file(case, self.table) for case in dict(self._jobs())]

    def all_data(self, wildcards: Wildcards) -> list[Path]:
        """Return the datasets of all baselines."""
        return [self.products.results / f"accuracy/{case}/{solver}.nc" for case, solver in self._jobs()]

    def all_costs(self, wildcards: Wildcards) -> list[Path]:
        """Return the costs of all baselines."""
        return [self.products.results / f"costs/accuracy/{case}/{solver}.json" for case, solver in self._jobs()]

    def export_params(self, wildcards: Wildcards) -> str:
        """Return what the tables depend on beside their files: the settings and the code of each job."""
        return canonical([case_job(self.products.cases[case], solver) for case, solver in self._jobs()])

    def kept_tier(self, wildcards: Wildcards) -> list[Path]:
        """Return no file; exit at a tier that measures its baselines, so that the package keeps nothing for it."""
        tier = self.products.plan.tier
        if tier not in read_kept_tiers(self.products.config):
            raise SystemExit(f"Error: tier: got {tier}; allowed: one that accuracy.yaml lists in {KEPT_TIERS}")
        return []

    def package_tables(self, wildcards: Wildcards) -> list[str]:
        """Return the package's tables that the figure of a case reads; none where all its solvers are measured."""
        if not self.products.cases[wildcards.case].kept:
            return []
        return [os.path.relpath(file) for file in (baselines.FILE, baselines.table_file(wildcards.case))]

    def _jobs(self) -> list[tuple[str, str]]:
        """Return case and solver of all baselines that can be measured."""
        cases = self.products.cases.values()
        return [(case.name, solver) for case in cases for solver in case.baselines if is_installed(solver)]
