"""Seals of results: what a file holds and what it was made from, so that no damage and no change stays unseen.

Each job that ends writes a seal beside its results, below `seals/`: the digests of its outputs, those of the results
that it read, and the digest of its settings and code. A result whose content is not that of its seal was damaged or
replaced. One that was made from other settings, other code or other results than there are now is out of date.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

from contactsim.errors import InputError
from contactsim.files import write_text

FOLDER = "seals"
"""Folder of the seals, below that of a tier's results."""
UNSEALED = {FOLDER, "logs", "gallery", "bundle"}
"""Folders of a tier's results whose files need no seals; a bundle has checksums of its own."""
ASIDE = ".aside"
"""Ending of a file that was set aside because its seal does not hold for it."""


@dataclass(frozen=True)
class Content:
    """What a file held when it was sealed, and by which it is known to be unchanged without being read.

    Parameters
    ----------
    sha256 : str
        Digest of its content.
    size : int
        In bytes.
    changed : int
        When it was last changed, ns.
    """

    sha256: str
    size: int
    changed: int

    @classmethod
    def of(cls, path: Path) -> Content:
        """Return the content of a file."""
        before = path.stat()
        with path.open("rb") as file:
            digest = hashlib.file_digest(file, "sha256").hexdigest()
        return cls(digest, before.st_size, before.st_mtime_ns)

    def is_that_of(self, path: Path, reads: bool = False) -> bool:
        """Return True if a file holds this content; one with the same size and time is read only if `reads`."""
        found = path.stat()
        if not reads and (found.st_size, found.st_mtime_ns) == (self.size, self.changed):
            return True
        return found.st_size == self.size and Content.of(path).sha256 == self.sha256


@dataclass(frozen=True)
class Seal:
    """What a job read and wrote.

    Parameters
    ----------
    rule : str
        Name of the job's rule.
    wildcards : dict
        Its wildcards.
    made_from : str
        Digest of its settings and code.
    inputs : dict
        Digest of each result that it read, by its place below the folder of the tier.
    outputs : dict
        Content of each file that it wrote, by its place.
    """

    rule: str
    wildcards: dict[str, str]
    made_from: str
    inputs: dict[str, str]
    outputs: dict[str, Content]

    @classmethod
    def read(cls, path: Path) -> Seal:
        """Read a seal; raise InputError for what is none."""
        try:
            parts = json.loads(path.read_text(encoding="utf-8"))
            return cls(**parts | {"outputs": {name: Content(**item) for name, item in parts["outputs"].items()}})
        except (ValueError, TypeError, KeyError, AttributeError) as error:
            raise InputError("seal", path, "a seal of results; remove it, and its results are made again") from error

    def write(self, results: Path) -> None:
        """Write the seal beside the results of a tier, once for each file that the job wrote."""
        text = json.dumps(asdict(self), indent=1)
        for place in self.outputs:
            write_text(text, seal_path(results, place))


def seal_path(results: Path, place: str) -> Path:
    """Return the file of the seal of a result at a place below the folder of a tier."""
    return results / FOLDER / f"{place}.json"


def read_seals(results: Path) -> Iterator[tuple[str, Seal]]:
    """Yield the place of each sealed result of a tier, and its seal."""
    folder = results / FOLDER
    for path in sorted(folder.rglob("*.json")):
        yield str(path.relative_to(folder))[: -len(".json")], Seal.read(path)


def check_inputs(results: Path, paths: Iterable[Path]) -> dict[str, str]:
    """Return the digests of results that a job reads, by place; files elsewhere are left out.

    Raises
    ------
    InputError
        For a result without a seal, or with another content than its seal says.
    """
    found: dict[str, str] = {}
    for path in paths:
        if results not in path.parents:
            continue
        place = str(path.relative_to(results))
        seal = seal_path(results, place)
        remedy = "remove it, and it is made again"
        if not seal.exists():
            raise InputError("result", path, f"one that the workflow made, with a seal; {remedy}")
        content = Seal.read(seal).outputs[place]
        if not content.is_that_of(path, reads=True):
            raise InputError("result", path, f"what was written when it was made; since then it was changed: {remedy}")
        found[place] = content.sha256
    return found


def verify(results: Path) -> dict[str, str]:
    """Return what is wrong with the results of a tier, by place; every file is read.

    Damaged and missing files are told, those without a seal, and those that were made from other results than there
    are.
    """
    wrong: dict[str, str] = {}
    seals = dict(read_seals(results))
    for place, seal in seals.items():
        path = results / place
        if not path.exists():
            wrong[place] = "is gone"
        elif not seal.outputs[place].is_that_of(path, reads=True):
            wrong[place] = "was changed since it was made"
        else:
            others = [name for name, digest in seal.inputs.items() if digest_of(seals, name) != digest]
            if others:
                wrong[place] = f"was made from another {others[0]}"
    for path in sorted(results.rglob("*")):
        place = str(path.relative_to(results))
        is_result = path.is_file() and path.suffix != ASIDE and Path(place).parts[0] not in UNSEALED
        if is_result and place not in seals:
            wrong[place] = "has no seal"
    return wrong


def digest_of(seals: dict[str, Seal], place: str) -> str | None:
    """Return the digest of the result at a place; None where there is none."""
    return seals[place].outputs[place].sha256 if place in seals else None
