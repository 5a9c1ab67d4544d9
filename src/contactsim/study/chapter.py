"""Read a chapter of the config: its studies, figures and claims, with what the tier overrides."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from contactsim.errors import InputError
from contactsim.study.claim_plan import Claim, read_claim
from contactsim.study.figure_plan import Figure, read_figure
from contactsim.study.plain_yaml import load_yaml
from contactsim.study.reading import SAFE_NAME, SAFE_NAME_FORM, Key, mapping, read
from contactsim.study.study import Study
from contactsim.study.tier_overrides import TieredFile, overlaid

CHAPTER_KEYS = {
    "studies": Key(mapping, "a mapping from names to studies", {}),
    "figures": Key(mapping, "a mapping from names to figures"),
    "claims": Key(mapping, "a mapping from names to claims", {}),
    "findings": Key(mapping, "a mapping from names to findings, which are none of the claims' names", {}),
}
RESCALED_KEYS = ("hurst_exponent", "rms_height", "rms_gradient", "short_cutoff")
"""Keys that leave the random waves of a self-affine surface the same, but for their size and how many there are."""


@dataclass(frozen=True)
class Chapter:
    """Studies, figures and claims of one file of the config, by name; findings are among the claims."""

    studies: dict[str, Study]
    figures: dict[str, Figure]
    claims: dict[str, Claim]


@dataclass(frozen=True)
class ChapterReader:
    """Reader of the chapters at one tier.

    Parameters
    ----------
    tier : str
        Name of the tier.
    overrides : mapping
        Keys that the tier changes, by study.
    seed : int
        Root of all random numbers.
    reserved_names : collection of str
        Names that no study can have.
    data_folders : list of str
        Folders beside the project's from which measured heights may be read.
    """

    tier: str
    overrides: Mapping[str, object]
    seed: int
    reserved_names: Collection[str]
    data_folders: Sequence[str]

    def read(self, file: Path) -> Chapter:
        """Return the chapter in a file.

        Raises
        ------
        InputError
            For anything in the file that cannot be used.
        """
        sections = read(load_yaml(file), CHAPTER_KEYS, file)
        for name in sections["studies"]:
            self._check_study_name(name, sections["figures"], file)
        for part in ("claims", "findings"):
            for name in sections[part]:
                if not SAFE_NAME.fullmatch(name):
                    raise InputError(part, name, SAFE_NAME_FORM, file)
        for name in set(sections["claims"]) & set(sections["findings"]):
            raise InputError(f"findings.{name}", name, "a name that no claim has", file)
        studies = {name: self._read_study(name, section, file) for name, section in sections["studies"].items()}
        _check_shared_surfaces(studies)
        return Chapter(
            studies,
            {name: read_figure(name, section, file, studies) for name, section in sections["figures"].items()},
            {
                name: read_claim(name, section, file, studies, part)
                for part in ("claims", "findings")
                for name, section in sections[part].items()
            },
        )

    def _check_study_name(self, name: object, figures: Mapping[str, object], file: Path) -> None:
        """Raise InputError for a name that no study can have."""
        if not SAFE_NAME.fullmatch(str(name)) or name in (*self.reserved_names, *figures):
            allowed = f"{SAFE_NAME_FORM}; no figure's name and none of {', '.join(self.reserved_names)}"
            raise InputError("studies", name, allowed, file)

    def _read_study(self, name: str, section: object, file: Path) -> Study:
        """Return a study with what the tier overrides; the study of the chapter must be right too."""
        override = self.overrides.get(name, {})
        if not isinstance(override, dict):
            tiers = file.with_name("tiers.yaml")
            raise InputError(f"{self.tier}.studies.{name}", override, "a mapping of keys to override", tiers)
        if override:
            Study.read(name, section, file, self.seed, self.data_folders)
            section = overlaid(mapping(section), override)
        source = TieredFile(file, self.tier) if override else file
        return Study.read(name, section, source, self.seed, self.data_folders)


def _check_shared_surfaces(studies: Mapping[str, Study]) -> None:
    """Raise InputError for a study that shares another's surfaces but describes them otherwise."""
    for study in studies.values():
        name = study.settings["same_surfaces_as"]
        if name is None:
            continue
        other, key = studies.get(name), f"studies.{study.name}.same_surfaces_as"
        if other is None or other.settings["same_surfaces_as"] is not None:
            names = ", ".join(name for name, own in studies.items() if own.settings["same_surfaces_as"] is None)
            raise InputError(key, name, f"one of {names}", study.file)
        first, second = (
            {k: v for k, v in own.settings["surface"].items() if k not in RESCALED_KEYS} for own in (study, other)
        )
        if first != second or first["kind"] != "self_affine":
            allowed = f"a study with the same `surface`, self_affine, but for {', '.join(RESCALED_KEYS)}"
            raise InputError(key, name, allowed, study.file)
