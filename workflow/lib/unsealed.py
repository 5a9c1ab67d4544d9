"""Results that are not what their seals say: found while Snakemake plans, so that they are made again.

Snakemake knows an output by its times and by what it remembers in `.snakemake`. A seal says what a result holds and
what it was made from (`contactsim.seals`), wherever the folder has been and whatever was lost.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from job import parameters_digest
from snakemake.iocontainers import Wildcards

from contactsim.errors import InputError
from contactsim.seals import ASIDE, Seal, seal_path

DONE = ".done"
"""Ending of the file by which a run is known to be whole. Its other files stay, as parts of them may serve again."""


def check_all_outputs(workflow: Any, results: Path) -> None:
    """Let every rule that runs a script check its outputs when Snakemake asks what they are made from."""
    for rule in workflow.rules:
        if rule.script and rule.output:
            rule.set_input(checked=OutputCheck(workflow, rule, results))


class OutputCheck:
    """An input function that names no file. Outputs that are not what they should be are out of the way after it."""

    __name__ = "checked"  # Snakemake names input functions in messages

    def __init__(self, workflow: Any, rule: Any, results: Path) -> None:
        self._workflow, self._rule, self._results = workflow, rule, results

    def __call__(self, wildcards: Wildcards) -> list[Path]:
        """Check the outputs of a job."""
        outputs = [Path(str(item.apply_wildcards(wildcards))) for item in self._rule.output]
        marks = [path for path in outputs if path.suffix == DONE] or outputs
        if not all(path.exists() for path in marks):
            return []  # they are to be made in any case
        for path in outputs:
            if path.exists() and self._results in path.parents:
                reason = self._wrong(path)
                if reason is None:
                    continue
                aside = path.with_name(path.name + ASIDE)
                path.rename(aside)
                for mark in marks:
                    mark.unlink(missing_ok=True)
                print(f"{path}: {reason}. It is set aside as {aside.name} and made again.", file=sys.stderr)
                return []
        reason = self._outdated(outputs[0], wildcards)
        if reason is not None:
            for mark in marks:
                mark.unlink()
            print(f"{outputs[0]}: {reason}. It is made again.", file=sys.stderr)
        return []

    def _seal(self, path: Path) -> Seal | None:
        """Return the seal of a file, None where there is none that can be read."""
        file = seal_path(self._results, self._place(path))
        try:
            return Seal.read(file) if file.exists() else None
        except InputError:
            return None

    def _place(self, path: Path) -> str:
        """Return the place of a file below the folder of the tier."""
        return str(path.relative_to(self._results))

    def _wrong(self, path: Path) -> str | None:
        """Return why a file is not what a job of this rule wrote; None if it is."""
        seal = self._seal(path)
        if seal is None or self._place(path) not in seal.outputs:
            return "has no seal, so it was not made here"
        return None if seal.outputs[self._place(path)].is_that_of(path) else "was changed since it was made"

    def _outdated(self, path: Path, wildcards: Mapping[str, str]) -> str | None:
        """Return why a result is out of date, where Snakemake cannot know it; None if it is not."""
        seal = self._seal(path)
        if seal is None:
            return None
        for place, digest in seal.inputs.items():
            source = self._results / place
            if not source.exists():
                return f"was made from {source}, which is gone"
            other = self._seal(source)
            if other is None or other.outputs[place].sha256 != digest:
                return f"was made from another {source}"
        if self._workflow.persistence.metadata(str(path)):
            return None  # Snakemake compares the parameters itself
        parameters = {name: item(wildcards) if callable(item) else item for name, item in self._rule.params.items()}
        if parameters_digest(parameters) != seal.made_from:
            return "was made from other settings or by other code"
        return None
