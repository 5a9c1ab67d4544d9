"""What is priced of a study, loads or a path, and the knobs on which its accuracy depends.

Loads of a hard wall are solved on their own, and each has its error. Of smooth laws the past decides, so a path is
priced whole: its error is that of what it amounts to, its cost that of all its steps, and it has not converged if one
of them has not. Its increment is one knob more; of a slide it is that of the slide, and the tangential cutoff of the
lattice another. Whoever prices asks the kind of a study, and not what acts in it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import xarray as xr

from contactsim.contact.scene import ProblemKind
from contactsim.errors import InputError
from contactsim.interface.lattice import Lattice
from contactsim.observables.adhesion import SUMMARY
from contactsim.observables.forms import AVERAGED, form_of
from contactsim.observables.hysteresis import CYCLE
from contactsim.observables.linearity import AREA_LOAD
from contactsim.observables.peeling import ONSET
from contactsim.status import is_solved
from contactsim.study.kinds import problem_kind
from contactsim.study.reading import Key, listed, positive, read, whole
from contactsim.study.study import Study
from contactsim.variables import VARIABLES


@dataclass(frozen=True)
class Knob:
    """What can be turned: the kind of its values, one and several of them in words, and which of them is finest."""

    kind: Callable[[object], float]
    one: str
    several: str
    finest: Callable[..., float]

    def check(self, values: list, reference: float, file: Path, key: str) -> None:
        """Refuse what is not coarser than the reference that it is measured against."""
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
SETTING_KEYS = {name: Key(knob.kind, knob.one) for name, knob in KNOBS.items()}
KNOB_KEYS = {name: Key(listed(knob.kind), knob.several, []) for name, knob in KNOBS.items()}
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

    knobs: those that it has; quantities: whose error can be measured; without: keys that it has no use for, and what is
    said of them.
    """

    knobs = ("points", "tolerance")
    quantities = AVERAGED
    without = dict.fromkeys(
        ("increment", "thesis_increment"), "no such key: the study's loads are solved on their own, without increments"
    ) | {"tangential_cutoff": "no such key: the study does not slide"}

    def takes(self, study: Study) -> bool:
        """Whether the study has such loads."""
        return study.settings["path"] is None

    def loads(self, study: Study, loads: list[float]) -> dict[str, list[float]]:
        """The loads priced, by their dimension."""
        return {study.settings["load"]["name"]: loads}

    def changed(self, study: Study, loads: list[float], setting: Setting) -> dict:
        """What pricing changes in the study's settings beside points and tolerance: its loads."""
        return {"load": {"name": study.settings["load"]["name"], "values": sorted(loads)}}

    def turns(self, settings: dict) -> dict[str, float]:
        """Where a study has the knobs that not every study has: there are none."""
        return {}

    def units(self, study: Study) -> dict[str, str]:
        """Units of the knobs: none, as a tolerance is in grid steps."""
        return {}


class WholePath:
    """A path of smooth laws as a whole, every increment solved as it is asked for; names as those of `SingleLoads`."""

    knobs = (*SingleLoads.knobs, "increment")
    quantities = (*SUMMARY, *CYCLE, *AREA_LOAD)
    without = {
        "load": "no such key: the study follows a path, which is priced whole",
        "tangential_cutoff": "no such key: the study does not slide",
    }

    def takes(self, study: Study) -> bool:
        """Whether the study follows smooth laws."""
        return problem_kind(study.settings["effects"]) is ProblemKind.COHESIVE

    def loads(self, study: Study, loads: None) -> dict[str, list[float]]:
        """All of the path."""
        return {}

    def changed(self, study: Study, loads: None, setting: Setting) -> dict:
        """The increment; and that none is interpolated, and no fields are kept."""
        path = {key: value for key, value in study.settings["load"].items() if key != "values"}
        asked = {"increments": {"kind": "requested"}, "snapshots": None}
        return asked | {"load": path | {"increment": setting.increment}}

    def turns(self, settings: dict) -> dict[str, float]:
        """The increment, unless it adapts itself."""
        asked = settings["increments"]["kind"] == "requested"
        return {"increment": settings["load"]["increment"]} if asked else {}

    def units(self, study: Study) -> dict[str, str]:
        """The increment's is that of what the path prescribes; a tolerance is in parts of the strength."""
        return {"increment": VARIABLES[study.settings["load"]["control"]][0]}


class WholeSlide(WholePath):
    """A path that presses and slides, whose slide is turned; as `WholePath`."""

    knobs = (*WholePath.knobs, "tangential_cutoff")
    quantities = (*WholePath.quantities, *ONSET)
    without = {"load": WholePath.without["load"]}

    def takes(self, study: Study) -> bool:
        """Whether the study slides over a lattice."""
        pairing = study.settings["pairing"] or {}
        return study.settings["slide"] is not None and pairing.get("kind") == "lattice"

    def changed(self, study: Study, loads: None, setting: Setting) -> dict:
        """The increment of the slide and the tangential cutoff; no increment is interpolated, no fields are kept."""
        asked = {"increments": {"kind": "requested"}, "snapshots": None}
        asked["slide"] = study.settings["slide"] | {"increment": setting.increment}
        return asked | {"pairing": study.settings["pairing"] | {"tangential_cutoff": setting.tangential_cutoff}}

    def turns(self, settings: dict) -> dict[str, float]:
        """Increment, unless it adapts itself, and tangential cutoff."""
        asked = settings["increments"]["kind"] == "requested"
        cutoff = {"tangential_cutoff": settings["pairing"].get("tangential_cutoff", Lattice.tangential_cutoff)}
        return cutoff | ({"increment": settings["slide"]["increment"]} if asked else {})

    def units(self, study: Study) -> dict[str, str]:
        """A slide is a length; a cutoff counts tangential lengths."""
        return {"increment": "nm"}


KINDS: tuple[SingleLoads | WholePath, ...] = (WholeSlide(), WholePath(), SingleLoads())


def kind_of(study: Study) -> SingleLoads | WholePath | None:
    """The kind of a study; None of a hard wall that is taken along a path."""
    return next((kind for kind in KINDS if kind.takes(study)), None)


def read_turned(settings: dict, kind: SingleLoads | WholePath, file: Path, prefix: str) -> dict:
    """The sections of a case that are about knobs, of those that its kind has; every setting is below the reference."""

    def knobs(section: object, keys: dict[str, Key], key: str) -> dict:
        """A section with a value, or values, for each knob."""
        for name in set(kind.without) & set(section if isinstance(section, dict) else ()):
            raise InputError(f"{key}.{name}", section[name], kind.without[name], file)
        return read(section, {name: keys[name] for name in kind.knobs}, file, key)

    found = {part: knobs(settings[part], SETTING_KEYS, f"{prefix}.{part}") for part in ("settled", "reference")}
    turned = {f"{prefix}.settled": {name: [value] for name, value in found["settled"].items()}}
    found |= {"levels": knobs(settings["levels"], LEVEL_KEYS, f"{prefix}.levels"), "solvers": {}}
    for solver, section in settings["solvers"].items():
        key = f"{prefix}.solvers.{solver}"
        turned[key] = found["solvers"][solver] = knobs(section, KNOB_KEYS, key)
        if not any(turned[key].values()):
            raise InputError(key, section, f"{', or '.join(kind.knobs)}, or more than one", file)
    for key, section in turned.items():
        for name, values in section.items():
            KNOBS[name].check(values, found["reference"][name], file, f"{key}.{name}")
    return found


def solutions(data: xr.Dataset) -> xr.Dataset:
    """Loads as they are; of paths what each amounts to, all its transforms, and its first status that is a failure."""
    form = form_of(data)
    found = form.derive(data)
    if not form.is_path:
        return found
    failed = ~is_solved(data.status)
    first = data.status.isel(step=failed.argmax("step")).drop_vars("step", errors="ignore")
    return found[[name for name in WholeSlide.quantities if name in found]].assign(
        transforms=data.transforms.sum("step"), status=first
    )
