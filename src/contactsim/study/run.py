"""One job of a study: the values that it depends on, and the digests of these and of the code."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from contactsim.error_control.relations import FILE
from contactsim.paths.options import Setup
from contactsim.provenance import digest
from contactsim.solvers.registry import solver_module
from contactsim.study.scenes import build_setup
from contactsim.study.stages import computing_stage_digest


@dataclass(frozen=True)
class Run:
    """One job of a study.

    Parameters
    ----------
    study, variant : str
        Names of the study and of the variant.
    member : int
        Number in the ensemble.
    coordinates : dict
        Varied values by dimension of the study's dataset.
    settings : dict
        Every value that the run depends on.
    error : str
        Kind of error that it measures, of `keys.ERROR_RUNS`; empty for the study's own runs.
    """

    study: str
    variant: str
    member: int
    coordinates: dict[str, object]
    settings: dict
    error: str = ""

    @property
    def measures_error(self) -> bool:
        """True where it only measures an error."""
        return bool(self.error)

    @cached_property
    def setup(self) -> Setup:
        """Scene and options."""
        return build_setup(self.settings)

    @property
    def stage(self) -> str:
        """Stage of the workflow that computes it, of `stages.STAGES`."""
        if "auto" in self.settings:
            return "run_neglecting"
        return "run_to_accuracy" if "accuracy" in self.settings else "run"

    @cached_property
    def source(self) -> str:
        """Digest of the code that computes the run, its one solver, the libraries and the relations it is chosen by."""
        code = computing_stage_digest(self.stage, solver_module(self.settings["solver"]["kind"]))
        relations = [FILE.read_text(encoding="utf-8")] if "accuracy" in self.settings else []
        return digest(code, *relations)

    @cached_property
    def digest(self) -> str:
        """Digest of the settings and of the code that computes the run."""
        return digest(self.settings, self.source)

    @property
    def stem(self) -> str:
        """Path of the run's files below runs/ and costs/runs/, without their endings."""
        return f"{self.study}/{self.variant}/{self.member}"
