"""The knobs on which a study's accuracy depends, and the three kinds of solutions that have them.

Loads at a hard wall are solved on their own, and each has its error. A path of cohesive laws counts whole: its error is
that of its summary, its cost that of all steps, and one unconverged step makes it unconverged. A path has its increment
as a further knob; a slide over a lattice also has the tangential cutoff.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import xarray as xr

from contactsim.errors import InputError
from contactsim.interface.lattice import Lattice
from contactsim.observables.dataset_forms import AVERAGED, form_of
from contactsim.observables.friction import ONSET
from contactsim.observables.hysteresis import CYCLE
from contactsim.observables.linearity import AREA_LOAD
from contactsim.observables.path_summary import SUMMARY, SURFACE_SUMMARY
from contactsim.status import is_solved
from contactsim.study.kinds import study_kind
from contactsim.study.reading import Key, listed, positive, read, whole
from contactsim.study.study import Study
from contactsim.variables import RESULTS


@dataclass(frozen=True)
class Knob:
    """A knob: the reader of a value, words for one value and for several, and the function that finds the finest."""

    kind: Callable[[object], float]
    value_text: str
    values_text: str
    finest: Callable[..., float]

    def check(self, values: Sequence[float], reference: float, file: Path, key: str) -> None:
        """Refuse a value that is not coarser than its reference."""
        finest = self.finest(values, default=None)
        if finest is not None and self.finest(finest, reference) == finest:
            below = f"fewer than the reference's, {reference:g}"
            allowed = below if self.finest is max else f"above the reference's, {reference:g}"
            raise InputError(key, finest, allowed, file)


KNOBS = {
    "points": Knob(whole(2), "a whole number of grid points", "a list of grid points", max),
    "tolerance": Knob(positive, "a positive number, as a study's tolerance", "a list of tolerances", min),
    "increment": Knob(positive, "a positive number, as the increment of a path", "a list of increments", min),
    "tangential_cutoff": Knob(
        positive, "a positive number, as the `tangential_cutoff` of a pairing", "a list of cutoffs", max
    ),
}
SETTING_KEYS = {name: Key(knob.kind, knob.value_text) for name, knob in KNOBS.items()}
KNOB_KEYS = {name: Key(listed(knob.kind), knob.values_text, []) for name, knob in KNOBS.items()}
LEVEL_KEYS = {name: Key(listed(positive), "a list of relative errors", []) for name in KNOBS}


@dataclass(frozen=True)
class Setting:
    """One place of one knob: which is turned, grid points, tolerance, increment of a path, cutoff of a slide."""

    knob: str
    points: int
    tolerance: float
    increment: float | None = None
    tangential_cutoff: float | None = None

    @property
    def numbers(self) -> dict[str, float]:
        """The value of each knob that there is."""
        return {knob: getattr(self, knob) for knob in KNOBS if getattr(self, knob) is not None}


class SingleLoads:
    """Loads of a hard wall, each solved on its own.

    knobs: those that it has; quantities: whose error can be measured; unused_keys: keys that it does not use, and the
    reason.
    """

    knobs: tuple[str, ...] = ("points", "tolerance")
    quantities: tuple[str, ...] = AVERAGED
    unused_keys = dict.fromkeys(
        ("increment", "thesis_increment"), "no such key: the study's loads are solved on their own, without increments"
    ) | {"tangential_cutoff": "no such key: the study does not slide"}

    def accepts(self, study: Study) -> bool:
        """Return True where the study has such loads."""
        return study.settings["path"] is None

    def loads(self, study: Study, loads: Sequence[float] | None) -> dict[str, Sequence[float]]:
        """Return the selected loads by their dimension."""
        assert loads is not None, "a case without loads is refused when it is read"
        return {study.settings["load"]["name"]: loads}

    def edit_settings(self, study: Study, loads: Sequence[float] | None, setting: Setting) -> dict[str, Any]:
        """Return the edits of the study's settings beside points and tolerance: its loads."""
        assert loads is not None, "a case without loads is refused when it is read"
        return {"load": {"name": study.settings["load"]["name"], "values": sorted(loads)}}

    def knob_values(self, study: Study) -> dict[str, float]:
        """Return a study's values of knobs that not every study has: none."""
        return {}

    def units(self, study: Study) -> dict[str, str]:
        """Return the units of knobs: none, as a tolerance is in grid steps."""
        return {}


class WholePath:
    """A path of smooth laws as a whole, every increment solved as it is asked for; names as those of `SingleLoads`."""

    knobs: tuple[str, ...] = (*SingleLoads.knobs, "increment")
    quantities: tuple[str, ...] = tuple(dict.fromkeys((*SUMMARY, *SURFACE_SUMMARY, *CYCLE, *AREA_LOAD)))
    unused_keys = {
        "load": "no such key: the study follows a path, which is priced whole",
        "tangential_cutoff": "no such key: the study does not slide",
    }

    def accepts(self, study: Study) -> bool:
        """Return True where the study follows a path of cohesive laws."""
        return study_kind(study.settings).needs_path

    def loads(self, study: Study, loads: Sequence[float] | None) -> dict[str, Sequence[float]]:
        """Return no selection: the path counts whole."""
        return {}

    def edit_settings(self, study: Study, loads: Sequence[float] | None, setting: Setting) -> dict[str, Any]:
        """Return the edited increment; none is interpolated, and no fields are kept."""
        path = {key: value for key, value in study.settings["load"].items() if key != "values"}
        edits: dict[str, Any] = {"increments": {"kind": "requested"}, "snapshots": None}
        return edits | {"load": path | {"increment": setting.increment}}

    def knob_values(self, study: Study) -> dict[str, float]:
        """Return the increment, unless it is adaptive."""
        is_requested = study.settings["increments"]["kind"] == "requested"
        return {"increment": study.settings["load"]["increment"]} if is_requested else {}

    def units(self, study: Study) -> dict[str, str]:
        """Return the unit of the increment, that of the path's control; a tolerance is in parts of the strength."""
        return {"increment": RESULTS[study.settings["load"]["control"]].unit}


class WholeSlide(WholePath):
    """A path that presses and slides, whose slide is turned; as `WholePath`."""

    knobs = (*WholePath.knobs, "tangential_cutoff")
    quantities = (*WholePath.quantities, *ONSET)
    unused_keys = {"load": WholePath.unused_keys["load"]}

    def accepts(self, study: Study) -> bool:
        """Return True where the study slides over a lattice."""
        pairing = study.settings["pairing"] or {}
        return study.settings["slide"] is not None and pairing.get("kind") == "lattice"

    def edit_settings(self, study: Study, loads: Sequence[float] | None, setting: Setting) -> dict[str, Any]:
        """Return the edited increment of the slide and tangential cutoff; none is interpolated, no fields are kept."""
        edits: dict[str, Any] = {"increments": {"kind": "requested"}, "snapshots": None}
        edits["slide"] = study.settings["slide"] | {"increment": setting.increment}
        return edits | {"pairing": study.settings["pairing"] | {"tangential_cutoff": setting.tangential_cutoff}}

    def knob_values(self, study: Study) -> dict[str, float]:
        """Return the increment, unless it is adaptive, and the tangential cutoff."""
        settings = study.settings
        is_requested = settings["increments"]["kind"] == "requested"
        cutoff = {"tangential_cutoff": settings["pairing"].get("tangential_cutoff", Lattice.tangential_cutoff)}
        return cutoff | ({"increment": settings["slide"]["increment"]} if is_requested else {})

    def units(self, study: Study) -> dict[str, str]:
        """Return the unit of the slide's increment; a cutoff counts tangential lengths."""
        return {"increment": "nm"}


KINDS: tuple[SingleLoads | WholePath, ...] = (WholeSlide(), WholePath(), SingleLoads())


def find_case_kind(study: Study) -> SingleLoads | WholePath | None:
    """Return the kind of a study; None for a hard wall along a path."""
    return next((kind for kind in KINDS if kind.accepts(study)), None)


def read_knobs(settings: Mapping[str, Any], kind: SingleLoads | WholePath, file: Path, prefix: str) -> dict[str, Any]:
    """Return the sections of a case about the knobs of its kind; every setting is coarser than the reference."""

    def knobs(section: object, keys: Mapping[str, Key], key: str) -> dict[str, Any]:
        """A section with a value, or values, for each knob."""
        for name, value in section.items() if isinstance(section, dict) else ():
            if name in kind.unused_keys:
                raise InputError(f"{key}.{name}", value, kind.unused_keys[name], file)
        return read(section, {name: keys[name] for name in kind.knobs}, file, key)

    sections: dict[str, Any] = {
        part: knobs(settings[part], SETTING_KEYS, f"{prefix}.{part}") for part in ("settled", "reference")
    }
    values_by_key = {f"{prefix}.settled": {name: [value] for name, value in sections["settled"].items()}}
    sections |= {"levels": knobs(settings["levels"], LEVEL_KEYS, f"{prefix}.levels"), "solvers": {}}
    for solver, section in settings["solvers"].items():
        key = f"{prefix}.solvers.{solver}"
        values_by_key[key] = sections["solvers"][solver] = knobs(section, KNOB_KEYS, key)
        if not any(values_by_key[key].values()):
            raise InputError(key, section, f"{', or '.join(kind.knobs)}, or more than one", file)
    for key, section in values_by_key.items():
        for name, values in section.items():
            KNOBS[name].check(values, sections["reference"][name], file, f"{key}.{name}")
    return sections


def summarise_solutions(data: xr.Dataset) -> xr.Dataset:
    """Return loads as they are, and paths as their summaries with all transforms and the first failed status."""
    form = form_of(data)
    summary = form.derive(data)
    if not form.is_path:
        return summary
    failed = ~is_solved(data.status)
    first = data.status.isel(step=failed.argmax("step")).drop_vars("step", errors="ignore")
    return summary[[name for name in WholeSlide.quantities if name in summary]].assign(
        transforms=data.transforms.sum("step"), status=first
    )
