"""Sections of a study with their defaults, as they stand in the config and in each variant."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from contactsim.errors import InputError
from contactsim.interface.registry import EFFECTS
from contactsim.study.keys import BODIES, MODULI, RIGID, SECTION_KINDS, STUDY_KEYS
from contactsim.study.kinds import study_kind
from contactsim.study.reading import Key, choice, keys_of, read
from contactsim.study.sections import effect_sections, read_slide_section


@dataclass(frozen=True)
class StudySections:
    """The sections that the runs of a study depend on.

    Parameters
    ----------
    study : str
        Name of the study.
    settings : dict
        Settings of the study.
    file : object
        File that they stand in, for messages.
    """

    study: str
    settings: dict
    file: object

    @property
    def names(self) -> list[str]:
        """Names of the sections."""
        path = study_kind(self.settings).sections
        others = [name for name in ("counter_body", "pairing", "slide") if self.settings[name] is not None]
        return ["surface", "body", *others, "solver", *path, *effect_sections(self.settings)]

    def of_variant(self, varied: dict) -> tuple[dict[str, dict], int | None]:
        """Return the sections of a variant with their defaults, and its grid points."""
        sections = {name: self.settings[name] for name in self.names}
        points = self.settings["points"]
        for name, value in varied.items():
            if name == "points":
                points = read({name: value}, {name: STUDY_KEYS[name]}, self.file, f"studies.{self.study}.vary")[name]
                continue
            head, _, tail = str(name).partition(".")
            if tail not in self._own_keys.get(head, ()):
                keys = ", ".join(
                    f"{part}.{key}" for part, own in self._own_keys.items() for key in own if key != "kind"
                )
                raise InputError(f"studies.{self.study}.vary", name, f"a key of this study: points, {keys}", self.file)
            sections[head] = sections[head] | {tail: value}
        return {name: self._part(name, section) for name, section in sections.items()}, points

    @cached_property
    def _own_keys(self) -> dict[str, tuple[str, ...]]:
        """Keys of each section, which a variant can change."""
        return {name: tuple(self._part(name, self.settings[name])) for name in self.names}

    def _part(self, name: str, section: dict) -> dict:
        """Return a section with its defaults; most runs of a study share all sections but one."""
        key = name, repr(section)
        if key not in self._parts:
            self._parts[key] = self._read_part(name, section)
        return self._parts[key]

    @cached_property
    def _parts(self) -> dict[tuple[str, str], dict]:
        """Sections that have been read."""
        return {}

    def _read_part(self, name: str, section: dict) -> dict:
        """Return a section with its defaults: the keys of its `kind`, or of the effect that it is named for."""
        prefix = f"studies.{self.study}.{name}"
        if name in EFFECTS:
            return read(section, keys_of(EFFECTS[name]), self.file, prefix)
        if name == "slide":
            return read_slide_section(section, self.file, prefix)
        kinds, class_of = SECTION_KINDS[name]
        key = Key(choice(kinds), f"one of {', '.join(sorted(kinds))}")
        own = {"kind": section["kind"]} if "kind" in section else {}
        kind = read(own, {"kind": key}, self.file, prefix)["kind"]
        moduli = MODULI if name in BODIES and kind != RIGID else {}
        keys = {"kind": key, **keys_of(class_of(kind)), **moduli}
        values = read(section, keys, self.file, prefix)
        return {key: value for key, value in values.items() if key not in MODULI or value is not None}
