"""Seals of results: what a file holds and what it was made from, so that no damage and no change stays unseen.

Each job that ends writes a seal beside its results, below `seals/`: the digests of its outputs, those of the results
that it read, and the digest of its settings and code. A result whose content is not that of its seal was damaged or
replaced. One that was made from other settings, other code or other results than there are now is out of date.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable
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


def content_digest(path: Path) -> str:
    """Return the digest of what a file holds."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


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
        Digest of each file that it wrote, by its place.
    """

    rule: str
    wildcards: dict[str, str]
    made_from: str
    inputs: dict[str, str]
    outputs: dict[str, str]

    @classmethod
    def read(cls, path: Path) -> Seal:
        """Read a seal; raise InputError for what is none."""
        try:
            seal = cls(**json.loads(path.read_text(encoding="utf-8")))
            if not all(map(_is_below, [*dict(seal.inputs), *dict(seal.outputs)])):
                raise ValueError
            return seal
        except (AttributeError, ValueError, TypeError) as error:
            raise InputError("seal", path, "a seal of results; remove it, and its results are made again") from error

    def write(self, results: Path) -> None:
        """Write the seal beside the results of a tier, once for each file that the job wrote."""
        text = json.dumps(asdict(self), indent=1)
        for place in self.outputs:
            write_text(text, seal_path(results, place))


def _is_below(place: str) -> bool:
    """Return True for a place that lies below the folder of a tier, wherever that is."""
    return not Path(place).is_absolute() and ".." not in Path(place).parts


def seal_path(results: Path, place: str) -> Path:
    """Return the file of the seal of a result at a place below the folder of a tier."""
    return results / FOLDER / f"{place}.json"


def read_seals(results: Path) -> tuple[dict[str, Seal], list[str]]:
    """Return the seal of each sealed result of a tier, by place, and the places whose seals cannot be read."""
    folder = results / FOLDER
    found, broken = {}, []
    for path in sorted(folder.rglob("*.json")):
        place = str(path.relative_to(folder))[: -len(".json")]
        try:
            found[place] = Seal.read(path)
        except InputError:
            broken.append(place)
    return found, broken


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
        found[place] = content_digest(path) if path.is_file() else ""
        if found[place] != Seal.read(seal).outputs.get(place):
            raise InputError("result", path, f"what was written when it was made; since then it was changed: {remedy}")
    return found


def verify(results: Path) -> tuple[int, dict[str, str]]:
    """Return how many results of a tier have seals, and what is wrong with results, by place; every file is read.

    Damaged and missing files are told, those without a seal, and those that were made from other results than there
    are.

    Raises
    ------
    InputError
        For a folder without seals.
    """
    if not (results / FOLDER).is_dir():
        raise InputError("folder", results, "that of a tier's results, such as results/standard, with its seals")
    seals, broken = read_seals(results)
    wrong = dict.fromkeys(broken, "has a seal that cannot be read")
    for place, seal in seals.items():
        path = results / place
        if not path.exists():
            wrong[place] = "is gone"
        elif not path.is_file() or content_digest(path) != seal.outputs.get(place):
            wrong[place] = "was changed since it was made"
        else:
            others = [name for name, digest in seal.inputs.items() if digest_of(seals, name) != digest]
            if others:
                wrong[place] = f"was made from another {others[0]}"
    for path in sorted(results.rglob("*")):
        place = str(path.relative_to(results))
        is_result = path.is_file() and path.suffix != ASIDE and Path(place).parts[0] not in UNSEALED
        if is_result and place not in seals and place not in wrong:
            wrong[place] = "has no seal"
    return len(seals), wrong


def digest_of(seals: dict[str, Seal], place: str) -> str | None:
    """Return the digest of the result at a place; None where there is none."""
    return seals[place].outputs.get(place) if place in seals else None
