"""Differences between studies of the two kinds of problem: their keys, loads and options."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Protocol

from contactsim.contact.problem_kind import ProblemKind
from contactsim.interface.hard_wall import HardWall
from contactsim.interface.registry import EFFECTS
from contactsim.paths.increments import INCREMENTS


class StudyKind(Protocol):
    """Differences between studies of the two kinds of problem.

    Attributes
    ----------
    keys
        Keys that studies of the other kind have no use for.
    sections
        Parts that runs depend on.
    needs_path
        True where single loads have no meaning.
    """

    keys: tuple[str, ...]
    sections: tuple[str, ...]
    needs_path: bool

    def run_settings(self, settings: Mapping, member: int) -> dict:
        """Return what a run of that member keeps, as settings."""
        ...

    def options(self, settings: Mapping) -> dict[str, Any]:
        """Return the run options that only this kind has."""
        ...


class HardWallStudy:
    """Loads at a hard wall."""

    keys: tuple[str, ...] = ("keep",)
    sections: tuple[str, ...] = ()
    needs_path = False

    def run_settings(self, settings: Mapping, member: int) -> dict:
        """Return what is kept of each solution."""
        return {"keep": settings["keep"]}

    def options(self, settings: Mapping) -> dict[str, Any]:
        """Return what is kept of each solution."""
        return {"keep": tuple(settings["keep"])}


class CohesiveStudy:
    """Paths of cohesive laws."""

    keys: tuple[str, ...] = ("increments", "snapshots", "snapshot_members")
    sections: tuple[str, ...] = ("increments",)
    needs_path = True

    def run_settings(self, settings: Mapping, member: int) -> dict:
        """Return where snapshots are kept, and if they have fields."""
        fields = member < (settings["snapshot_members"] or settings["members"])
        return {"snapshots": settings["snapshots"], "keep_fields": fields}

    def options(self, settings: Mapping) -> dict[str, Any]:
        """Return the increments and what is kept at snapshots."""
        section = dict(settings["increments"])
        return {
            "increments": INCREMENTS[section.pop("kind")](**section),
            "snapshots": tuple(settings["snapshots"] or ()),
            "keep_fields": settings["keep_fields"],
            "until": settings["load"].get("until"),
        }


STUDY_KINDS: dict[ProblemKind, StudyKind] = {
    ProblemKind.HARD_WALL: HardWallStudy(),
    ProblemKind.COHESIVE: CohesiveStudy(),
}


def problem_kind(effects: Sequence[str]) -> ProblemKind:
    """Return the kind of problem that effects pose, by their names in the config."""
    smooth = any(EFFECTS[name] is not HardWall for name in effects)
    return ProblemKind.COHESIVE if smooth else ProblemKind.HARD_WALL


def study_kind(settings: Mapping) -> StudyKind:
    """Return what is special about a study or run with these settings."""
    return STUDY_KINDS[problem_kind(settings["effects"])]
