"""Effects that a study leaves out because they are negligible: by the maps, and by a check on a sample.

The maps say which effects may be left out to a tolerance. A sample of members is solved with and without them on a
coarser grid, which costs little and changes the effect of an effect hardly; what the check does not bear out stays. An
effect that the maps find near the tolerance is checked as well; one that they do not know stays.
"""

from __future__ import annotations

import json
import logging
import time
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path

import numpy as np
import xarray as xr

from contactsim import dataset
from contactsim.contact.scene import Scene
from contactsim.contact.simplification import SIMPLIFICATIONS
from contactsim.error_control import control
from contactsim.error_control.control import Outcome
from contactsim.error_control.effect_maps import FILE, change, expected, reduced
from contactsim.error_control.options import coarser, size_of
from contactsim.error_control.scaling import reach_of, strength_of
from contactsim.errors import SceneError
from contactsim.provenance import computing_digest, digest
from contactsim.status import LIMITS, process_zone
from contactsim.study import execute
from contactsim.study.execute import Files, keep, names_of
from contactsim.study.keys import is_smooth
from contactsim.study.scenes import points_of, scene_of
from contactsim.traits import Trait

logger = logging.getLogger(__name__)

NEAR = 10.0
"""Up to how many times the tolerance an effect is checked."""
LOOSE = 1e-5
"""Tolerance of a check along a path, in parts of the strength, if that of the run is not looser."""
COARSER = 4
"""How many times coarser the grid of the check is, where it shows all waves."""


@dataclass
class Decision:
    """What is left out of a variant of a study, and why.

    expected: by the maps, measured: on the sample, relative changes by effect; together: of all that is left out;
    words: what was done; work: transforms times points of the check, seconds: its CPU time, kept apart.
    """

    left_out: list[str] = field(default_factory=list)
    expected: dict[str, float | None] = field(default_factory=dict)
    measured: dict[str, float] = field(default_factory=dict)
    together: float = 0.0
    words: str = ""
    work: float = 0.0
    seconds: float = 0.0

    @property
    def text(self) -> str:
        """As it is kept."""
        return json.dumps({name: value for name, value in asdict(self).items() if name != "seconds"}, indent=1)


def source() -> str:
    """Digest of what decides: the code, and the maps."""
    return digest(computing_digest("contactsim.error_control.neglect"), FILE.read_text(encoding="utf-8"))


def effects_of(run: dict) -> list[str]:
    """The effects of a run that can be left out."""
    scene = scene_of(run | {"leave_out": []})
    return [name for name, less in SIMPLIFICATIONS.items() if _leaves(scene, less)]


def _leaves(scene: Scene, less: Callable[[Scene], Scene]) -> bool:
    """Whether a scene has an effect, and is one without it."""
    try:
        return less(scene) != scene
    except SceneError:
        return False


def foreseen(run: dict, within: float) -> list[str]:
    """The effects that the maps find negligible."""
    found = {name: expected(run, name) for name in effects_of(run)}
    return [name for name, value in found.items() if value is not None and value <= within]


def decide(run: dict, within: float, of: list[str], sample: int) -> Decision:
    """What may be left out of a run's scene so that quantities change by no more than a tolerance."""
    found = Decision(expected={name: expected(run, name) for name in effects_of(run)})
    samples = [_coarse(run | {"member": member}) for member in range(sample)]
    known: list[dict[str, Outcome]] = [{} for _ in samples]

    def measured(names: list[str]) -> float:
        """The largest change on the sample."""
        return max(change(one, names, of, solved) for one, solved in zip(samples, known, strict=True))

    near = [name for name, value in found.expected.items() if value is not None and value <= NEAR * within]
    found.left_out = [name for name in near if found.expected[name] <= within]
    found.together = measured(found.left_out) if found.left_out else 0.0
    if found.together > within or len(found.left_out) < len(near):  # one by one
        found.measured = {name: measured([name]) for name in near}
        found.left_out = [name for name, value in found.measured.items() if value <= within]
        found.together = measured(found.left_out) if found.left_out else 0.0
    while found.together > within:
        worst = max(found.left_out, key=found.measured.__getitem__)
        found.left_out.remove(worst)
        found.together = measured(found.left_out) if found.left_out else 0.0
    solved = [one for each in known for one in each.values()]
    found.work = sum(one.transforms * one.size for one in solved)
    found.seconds = sum(one.seconds for one in solved)
    found.words = _words(found, within)
    logger.info(found.words)
    return found


def _coarse(run: dict) -> dict:
    """A run on a coarser grid, which still carries its walk."""
    if "accuracy" in run:
        return coarser({name: value for name, value in run.items() if name != "accuracy"})
    scene = scene_of(run)
    points, modes = points_of(run, scene.upper.surface), scene.upper.surface.modes or 0
    coarsest = max(2 * modes + 1, scene.length / _finest(scene))
    coarser_by = next(by for by in (COARSER, COARSER // 2, 1) if by == 1 or points // by >= coarsest)
    if scene.upper.surface.points is not None:
        coarser_by = 1  # a measured surface has its own grid
    found = run | ({"points": points // coarser_by} if coarser_by > 1 else {})
    if is_smooth(run):
        found["tolerance"] = max(run["tolerance"], LOOSE)
    if is_smooth(run) and run["increments"]["kind"] == "nested":
        ratio = max(run["increments"]["ratio"] // coarser_by, 1)
        found["increments"] = run["increments"] | {"ratio": ratio, "between": min(run["increments"]["between"], ratio)}
    return found


def _finest(scene: Scene) -> float:
    """The longest grid spacing, nm, at which the model describes a scene's process zone."""
    if Trait.SMOOTH not in scene.traits:
        return np.inf
    return LIMITS["process_zone_step"][0] * process_zone(scene.contact_modulus, strength_of(scene), reach_of(scene))


def _words(found: Decision, within: float) -> str:
    """What was done, effect by effect."""
    parts, unknown = [], [name for name, value in found.expected.items() if value is None]
    for name, value in found.expected.items():
        if value is not None:
            checked = f", {_told(found.measured[name])} on the sample" if name in found.measured else ""
            parts.append(f"{name} {'left out' if name in found.left_out else 'kept'}, {value:.2g} by the maps{checked}")
    parts += [f"together {found.together:.2g} on the sample"] * bool(found.left_out)
    parts += [f"kept, as no map knows: {', '.join(unknown)}"] * bool(unknown)
    return f"within {within:g}: " + "; ".join(parts or ["there is nothing to leave out"])


def without(run: dict) -> tuple[dict, str]:
    """A run's settings without what is found negligible now, and what was decided; as they are where none is sought."""
    if "auto" not in run:
        return run, ""
    found = decide(run, **run["auto"])
    return run | {"leave_out": found.left_out}, found.words


def _told(change: float) -> str:
    """A change in words."""
    return f"{change:.2g}" if change < float("inf") else "not to be compared"


def run(
    settings: dict,
    source: str,
    target: str | Path,
    costs: str | Path,
    threads: int = 1,
    decision: str | Path | None = None,
    twin: str | Path | None = None,
) -> None:
    """Compute a run as it asks for, into its dataset and costs: see `march.run` and `confirm.run`.

    decision: the file that says what is negligible, of a run that leaves that out; twin: dataset of a run whose scene
    is the same without what the maps find negligible, which is taken over where that was left out of both.
    """
    follow = control.run if "accuracy" in settings else execute.run
    if decision is None:
        follow(settings, source, target, costs, threads)
        return
    found = json.loads(Path(decision).read_text(encoding="utf-8"))
    left = found["left_out"]
    told = {"left_out": ", ".join(left), "left_out_change": found["together"], "decision": found["words"]}
    size = size_of(scene_of(settings), points_of(settings, scene_of(settings).upper.surface))
    told["transforms_of_check"] = found["work"] / size if settings["member"] == 0 else 0.0
    settings = settings | {"leave_out": left}
    other = dataset.read(twin) if twin else None
    final = dataset.settings_of(other) if twin else {}
    same = settings | {name: final[name] for name in CHOSEN if name in final}
    if twin and reduced(final) == reduced(same):
        _take_over(other, same, source, (target, costs), told)
    else:
        follow(settings, source, target, costs, threads, told)


CHOSEN = ("points", "tolerance", "load", "increments")
"""What a run to an accuracy may have come to."""


def _take_over(data: xr.Dataset, settings: dict, source: str, files: Files, told: Mapping[str, object]) -> None:
    """A run's dataset from that of one whose scene is the same: nothing is spent."""
    begin = time.process_time()
    (dim,) = data.transforms.dims
    spent = {name: data[name] * 0 for name in ("transforms", "transforms_before") if name in data}
    data = data.drop_vars("point_digest").assign(spent | dict(told)).assign(seconds=(dim, np.zeros(data[dim].size)))
    if dim != "step":
        data = data.rename({dim: "step"})
    logger.info("taken over from a run whose scene is the same without %s", told["left_out"])
    keep(data, settings, names_of(settings, source), source, files, begin)
