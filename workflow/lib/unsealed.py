"""Results that are not what their seals say: found while Snakemake plans, so that they are made again.

Snakemake knows an output by its times and by what it remembers in `.snakemake`. A seal says what a result holds and
what it was made from (`contactsim.seals`), wherever the folder has been and whatever was lost.
"""

from __future__ import annotations

import atexit
import json
import sys
from pathlib import Path
from tempfile import NamedTemporaryFile
from typing import Any

from job import made_from, parameters_digest
from snakemake.iocontainers import Wildcards

from contactsim.errors import InputError
from contactsim.files import write_text
from contactsim.seals import ASIDE, FOLDER, Seal, content_digest, seal_path

DONE = ".done"
"""Ending of the file by which a run is known to be whole. Its other files stay, as parts of them may serve again."""


def check_all_outputs(workflow: Any, results: Path) -> None:
    """Let every rule that runs a script check its outputs when Snakemake asks what they are made from.

    A dry run tells what it finds, and changes nothing.
    """
    check = SealCheck(workflow, results, acts=not workflow.output_settings.dryrun)
    for rule in workflow.rules:
        if rule.script and rule.output:
            rule.set_input(checked=OutputCheck(check, rule))


class KnownContents:
    """Digests of files that were read before, and by which stamps of the system a file is known to be the same."""

    def __init__(self, path: Path) -> None:
        self._path = path
        try:
            self._stamps: dict[str, list[Any]] = dict(json.loads(path.read_text(encoding="utf-8")))
        except (OSError, TypeError, ValueError):
            self._stamps = {}
        self._is_new = False

    def digest(self, path: Path) -> str:
        """Return the digest of what a file holds; it is read if it may have been changed since it was read last."""
        found = path.stat()
        stamp = [found.st_size, found.st_mtime_ns, found.st_ctime_ns, found.st_ino]
        known = self._stamps.get(str(path))
        if isinstance(known, list) and known[:-1] == stamp:
            return str(known[-1])
        self._stamps[str(path)] = [*stamp, content_digest(path)]
        self._is_new = True
        return str(self._stamps[str(path)][-1])

    def save(self) -> None:
        """Write down what was read."""
        if self._is_new:
            write_text(json.dumps(self._stamps), self._path)


class OutputCheck:
    """An input function that names no file. Outputs that are not what they should be are out of the way after it.

    In a dry run they stay, and the function names a file that is newer, so that the job is listed.
    """

    __name__ = "checked"  # Snakemake names input functions in messages

    def __init__(self, check: SealCheck, rule: Any) -> None:
        self._check, self._rule = check, rule

    def __call__(self, wildcards: Wildcards) -> list[Path]:
        """Check the outputs of a job, unless it did not end: what it left may serve again."""
        outputs = [Path(str(item.apply_wildcards(wildcards))) for item in self._rule.output]
        if all(path.exists() for path in outputs if path.suffix == DONE):
            kept = [self._check.keeps(path) for path in outputs if path.exists()]
            return [] if all(kept) else self._check.newer_files
        return []


class SealCheck:
    """Follows results and what they were made from, and puts those out of the way that are to be made again."""

    def __init__(self, workflow: Any, results: Path, acts: bool) -> None:
        self._workflow, self._results, self._acts = workflow, results, acts
        self._rules = {rule.name: rule for rule in workflow.rules}
        self._kept: dict[Path, bool] = {}
        self._known = KnownContents(results / FOLDER / "known")
        self._newer = None if acts else NamedTemporaryFile(prefix="not_as_sealed_")  # noqa: SIM115 - lasts as long as the run
        if acts:
            atexit.register(self._known.save)

    @property
    def newer_files(self) -> list[Path]:
        """What is newer than all results: one file in a dry run, which lasts as long; else none."""
        return [] if self._newer is None else [Path(self._newer.name)]

    def keeps(self, path: Path) -> bool:
        """Return True if a file is what its seal says, and so is all that it was made from; else put it away."""
        if path not in self._kept:
            self._kept[path] = self._judge(path)
        return self._kept[path]

    def _judge(self, path: Path) -> bool:
        """Judge a file; see `keeps`."""
        if self._results not in path.parents or not path.exists():
            return path.exists()
        place, seal = str(path.relative_to(self._results)), self._seal(path)
        if seal is None or place not in seal.outputs:
            return self._set_aside(path, "has no seal, so it was not made here")
        if not all((self._results / mark).exists() for mark in seal.outputs if mark.endswith(DONE)):
            return False  # the run was begun again and did not end
        if not path.is_file() or self._known.digest(path) != seal.outputs[place]:
            return self._set_aside(path, "was changed since it was made", seal)
        reason = self._outdated(path, seal)
        if reason is None:
            return True
        self._unmake(seal)
        print(f"{path}: {reason}. It is made again.", file=sys.stderr)
        return False

    def _seal(self, path: Path) -> Seal | None:
        """Return the seal of a file, None where there is none that can be read."""
        file = seal_path(self._results, str(path.relative_to(self._results)))
        try:
            return Seal.read(file) if file.exists() else None
        except InputError:
            return None

    def _outdated(self, path: Path, seal: Seal) -> str | None:
        """Return why a result is out of date, where Snakemake cannot know it; None if it is not."""
        for place, digest in seal.inputs.items():
            source = self._results / place
            if not self.keeps(source):
                return f"was made from {source}, which is gone or made again"
            other = self._seal(source)
            if other is None or other.outputs.get(place) != digest:
                return f"was made from another {source}"
        if self._made_from_now(path, seal) not in (None, seal.made_from):
            return "was made from other settings or by other code"
        return None

    def _made_from_now(self, path: Path, seal: Seal) -> str | None:
        """Return the digest of what a result would be made from; None where Snakemake reruns it, or nothing makes it.

        Snakemake reruns what it remembers to be made from other parameters. After `--touch` it remembers those of now.
        """
        rule, wildcards = self._rules.get(seal.rule), Wildcards(fromdict=seal.wildcards)
        if rule is None:
            return None
        files = {str(file): file for file in (item.apply_wildcards(wildcards) for item in rule.output)}
        if str(path) not in files:
            return None
        try:
            parameters = {name: item(wildcards) if callable(item) else item for name, item in rule.params.items()}
        except (KeyError, ValueError, StopIteration, InputError):
            return None
        record = self._workflow.persistence.metadata(files[str(path)])
        if record and not {repr(value) for value in made_from(parameters).values()} <= set(record.get("params") or ()):
            return None
        return parameters_digest(parameters)

    def _set_aside(self, path: Path, reason: str, seal: Seal | None = None) -> bool:
        """Give a file that is not what it should be another name; return False."""
        if path.suffix == DONE:  # it holds nothing
            self._remove(path)
            return False
        aside = path.with_name(path.name + ASIDE)
        print(f"{path}: {reason}. It is set aside as {aside.name} and made again.", file=sys.stderr)
        if self._acts:
            path.rename(aside)
        if seal is not None:
            self._unmake(seal)
        return False

    def _unmake(self, seal: Seal) -> None:
        """Remove that by which Snakemake takes a job for done."""
        places = [place for place in seal.outputs if place.endswith(DONE)] or list(seal.outputs)
        for place in places:
            self._remove(self._results / place)
            self._kept[self._results / place] = False

    def _remove(self, path: Path) -> None:
        """Remove a file where there is one, but not in a dry run."""
        if self._acts:
            path.unlink(missing_ok=True)
