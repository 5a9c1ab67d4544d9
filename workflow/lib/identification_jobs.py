"""The jobs of the identification: candidates for the cell of the probe, their verdicts, and their figure."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from products import Products
from snakemake.iocontainers import Wildcards

from contactsim.analysis.candidate_shares import FILE
from contactsim.evaluation.identification import settings
from contactsim.evaluation.identification.settings import Identification
from contactsim.evaluation.identification.simulation import DOUBLED
from contactsim.provenance import canonical


@dataclass(frozen=True)
class CandidateJobs:
    """The jobs of the identification."""

    products: Products

    @property
    def _settings(self) -> Identification:
        """Return the settings; the rules that ask for them do not exist without."""
        assert self.products.identification is not None
        return self.products.identification

    @property
    def names(self) -> list[str]:
        """Return the names of all candidates."""
        return self._settings.names

    def datasets(self, candidate: str) -> list[str]:
        """Return the datasets of a candidate: of each interface, and of the strong one in twice the period."""
        folder = self.products.results / "identification" / candidate
        return [str(folder / f"{name}.nc") for name in (*self._settings.sections, DOUBLED)]

    def all_datasets(self) -> list[str]:
        """Return the datasets of all candidates, in their order."""
        return [file for name in self.names for file in self.datasets(name)]

    def table(self) -> str:
        """Return the table of verdicts in all candidates: that of the package, or that of the tier."""
        if self._settings.from_package:
            return os.path.relpath(FILE)
        return str(self.products.results / "identification/candidates.csv")

    def claims_candidates(self, wildcards: Wildcards) -> str | list[str]:
        """Return the table that the verdicts of a chapter read; nothing for other chapters."""
        own = self.products.identification
        return self.table() if own is not None and own.chapter == wildcards.chapter else []

    def full_tier(self, wildcards: Wildcards) -> list[Path]:
        """Return no file; exit at a tier that changes the candidates, whose table the package cannot keep."""
        plan = self.products.plan
        if set(plan.overrides[settings.NAME]) - {"from_package"}:
            raise SystemExit(f"Error: tier: got {plan.tier}; allowed: one that shortens no identification")
        return []

    def candidate_params(self, wildcards: Wildcards) -> str:
        """Return what the datasets of a candidate depend on."""
        return canonical(settings.candidate_job(self._settings, wildcards.candidate, self.products.plan.tier))

    def judgement_params(self, wildcards: Wildcards) -> str:
        """Return what the verdicts in all candidates depend on."""
        return canonical(settings.judgement_job(self._settings, self.products.plan.tier))

    def figure_params(self, wildcards: Wildcards) -> str:
        """Return what the figure depends on beside the table."""
        return canonical(settings.figure_job(self._settings, self.products.plan.tier))
