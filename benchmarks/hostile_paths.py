"""Small hostile load paths, each state judged by equations that are written once more.

    python benchmarks/hostile_paths.py [SEED [COUNT [FIRST]]]    # 400 scenes by default, on one core: half an hour

Lines of 97 to 128 points and surfaces of 24 to 48 a side, or far fewer; periodic and free; laws from smooth ones to the
steepest ramps of Dugdale's attraction; very soft and very stiff bodies; loads and approaches up and down; requested and
adaptive increments. Each scene is drawn from the seed and its number, and told with it unless it is right.

A scene is *wrong* if a state that is called solved breaks an equation, *told* if a status says that a state was not
found, *without end* if it takes more than a minute, else *right*. Bodies that a pull parts, and approaches that no gap
is left for, are right without a state.
"""

from __future__ import annotations

import itertools
import logging
import math
import signal
import sys
import time
import warnings
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import xarray as xr
from path_equations import Bodies, Equations, layer_compliance, own_law
from random_paths import SOLVED, Draw, draw_law, elasticity
from records import on_one_thread
from scipy.fft import irfftn, rfftn

import contactsim as cs
from contactsim.grid import Array

SEED, COUNT, SECONDS = 20261201, 400, 60
"""Seed and number of scenes, and seconds after which a scene is without end."""
LIMIT, ROUNDING = 1.001, 1e-9
"""Error, over what it may be, from which it is told; and what rounding may add, over the size of what is compared."""
MOTION, STEPS = 0.1, 5.0
"""Motions that count as no jump: in the laws' length, and in steps."""
KINDS = (
    "line, wall",
    "line, smooth",
    "line, coupled",
    "surface, wall",
    "surface, smooth",
    "free, wall",
    "free, smooth",
)
"""Kinds of scenes, in turn."""
VERDICTS = ("right", "told", "wrong", "without end", "refused")

logger = logging.getLogger("hostile_paths")


@dataclass(frozen=True)
class Case:
    """A scene, its elastic bodies, and how it is followed."""

    kind: str
    scene: cs.Scene
    bodies: Bodies
    options: dict[str, Any]

    @property
    def words(self) -> str:
        """The scene in a few words."""
        law, options = self.scene.laws[-1], self.options
        return (
            f"{type(law).__name__}{f' ramp {law.ramp:.1e}' if hasattr(law, 'ramp') else ''}, "
            f"{type(self.scene.upper.surface).__name__}, {self.scene.path.steps[0].control.name.lower()}, "
            f"{type(options['increments']).__name__}, {options['points']} points, tolerance {options['tolerance']:.1e}"
        )


def draw_case(number: int, seed: int) -> Case:
    """Return the random scene of a number."""
    draw = Draw(number, seed)
    kind = KINDS[number % len(KINDS)]
    form, interface = kind.split(", ")
    is_line = form == "line"
    sides = (97, 100, 113, 127, 128) if is_line else (24, 25, 31, 32, 48)
    points = draw.one_of(*((5, 8, 17, 33) if is_line else (8, 9, 16, 17))) if draw.chance(0.2) else draw.one_of(*sides)
    length, modulus = draw.power(0, 4), draw.power(-4, 3)
    height = length * draw.power(-3.5, -1.5)
    surface = draw_surface(draw, points, length, height, is_line)
    bodies = draw_bodies(draw, length, modulus, form == "free")
    modulus = 1 / sum(1 / body[1] for body in bodies)
    unit = height * draw.power(-2, 1)
    pull = modulus * 2 * np.pi * unit / length * draw.power(-2, 2.5)
    effects = draw_effects(draw, interface, pull, unit)
    path = draw_path(draw, effects[-1], modulus, unit, height, surface, points, form == "free")
    elastic: dict[int, Any] = {side: elasticity(*rest) for *rest, side in bodies}
    if form == "free":
        elastic = {side: cs.FreeHalfSpace(body[1], body[2]) for side, body in enumerate(bodies)}
    lower = cs.Body(cs.Flat.facing(surface), elastic.get(0))
    scene = cs.Scene(lower, cs.Body(surface, elastic.get(1)), effects, path)
    values = [step.value for step in path.steps]
    increments: Any = cs.Requested()
    if draw.chance(0.5):
        reach = max(np.ptp(values), 1e-3 * max(map(abs, values)))
        law_length = effects[-1].interaction_range
        increments = cs.Adaptive(error=law_length * draw.power(-3, -1), least=reach / 1000, most=reach / 2)
    options = {
        "points": points,
        "tolerance": draw.power(-8, -2),
        "increments": increments,
        "snapshots": sorted(set(values)),
    }
    return Case(kind, scene, bodies, options)


def draw_surface(draw: Draw, points: int, length: float, height: float, is_line: bool) -> Any:
    """Return a surface of about that height."""
    shape = (points,) * (1 if is_line else 2)
    kind = draw.one_of("round", "rough", "rough", "sinusoid", "noise", "flat")
    if kind == "round":
        return (cs.Cylinder if is_line else cs.Sphere)(length, radius=length**2 / 8 / height)
    if kind == "sinusoid":
        return cs.Sinusoid(length, height, periods=draw.one_of(1, 2, 3), dimensions=len(shape))
    if kind == "flat":
        return cs.Topography(np.zeros(shape), (length / points,) * len(shape))
    if kind == "rough" and points >= 24:
        return cs.SelfAffine(
            length, draw.between(0.1, 0.9), long_cutoff=length / draw.one_of(1, 2), short_cutoff=length / points * 4,
            rms_height=height, dimensions=len(shape), seed=draw.one_of(*range(1000)),
        )  # fmt: skip
    noise = np.random.default_rng(draw.one_of(*range(1000))).normal(size=shape)
    return cs.Topography(height * noise, (length / points,) * len(shape))


def draw_bodies(draw: Draw, length: float, modulus: float, is_free: bool) -> Bodies:
    """Return one elastic body, or two."""
    if is_free:
        return [("half_space", modulus * draw.power(0, 1), 0.3, np.inf, side) for side in range(draw.one_of(1, 2))]
    bodies = []
    for side in draw.one_of([0], [1], [0, 1]):
        ratio = draw.one_of(0.0, 0.3, 0.499, 0.5, -0.9)
        thickness = length * draw.power(-2, 1)
        bodies.append((draw.one_of("half_space", "layer"), modulus * draw.power(0, 1), ratio, thickness, side))
    return bodies


def draw_effects(draw: Draw, interface: str, pull: float, unit: float) -> tuple[Any, ...]:
    """Return laws of about that pull and length, with or without a wall."""
    if interface == "coupled":
        return (draw_law(draw, pull / unit, unit),)
    if interface == "wall":
        if draw.chance(0.3):
            return cs.HardWall(), cs.ExponentialAttraction(pull * unit, unit)
        return cs.HardWall(), cs.DugdaleAttraction(pull * unit, unit, ramp=draw.power(-3, 0))
    kind = draw.one_of("normal", "normal", "stiff", "repulsive")
    if kind == "stiff":
        return (cs.StiffCohesiveZone(pull * unit, pull / unit * draw.power(-0.5, 2), unit),)
    return ((cs.NormalCohesiveZone if kind == "normal" else cs.RepulsiveZone)(pull * unit * np.e, unit),)


def draw_path(
    draw: Draw, law: Any, modulus: float, unit: float, height: float, surface: Any, points: int, is_free: bool
) -> cs.LoadPath:
    """Return a path that presses, and in part of the scenes takes the load back, pulls, or slides."""
    count, heights = draw.one_of(4, 8, 12), surface.heights(points)
    touch, depth = -float(heights.max()), float(heights.max() - heights.mean())
    turns = draw.chance(0.6)
    kind = "approach" if is_free else draw.one_of("approach", "load", "slide")
    if kind == "approach" or (kind == "slide" and "t" not in law.reads):
        begin = touch - unit * draw.between(0.2, 3)
        deep = touch + unit * draw.power(-1, 0.5) + depth * draw.between(0, 0.8)
        end = begin - (deep - begin) * draw.between(0, 0.7)
        return cs.approaches([begin, deep, end] if turns else [begin, deep], (deep - begin) / count)
    span = modulus * (height + unit) * 2 * np.pi / surface.lengths[0]
    pressure = span * draw.power(-2.5, 0)
    if not isinstance(law, cs.DugdaleAttraction | cs.ExponentialAttraction):
        pressure = min(pressure, 0.5 * law.stiffness * unit)
    if kind == "slide":
        reach = law.tangential_length * draw.power(-0.5, 0.7)
        return cs.sliding([0.0, reach], reach / count, mean_pressure=pressure)
    path = cs.pressures([pressure * share for share in np.linspace(0.05, 1, count)])
    if turns and "Repulsive" not in type(law).__name__:
        path = path >> cs.pressures([-law.strength * draw.power(-3, 0) * share for share in np.linspace(0.03, 1, 8)])
    elif turns:
        path = path >> cs.pressures([pressure * share for share in np.linspace(0.97, 0.021, 5)])
    return path


class Judge:
    """What the states of a scene of the normal gap alone must fulfil. All errors are over what they may be."""

    def __init__(self, case: Case, data: xr.Dataset) -> None:
        self._scene, self._bodies, self._tolerance = case.scene, case.bodies, case.options["tolerance"]
        self._heights, self._law = data.heights.values, case.scene.laws[-1]
        self._has_wall, self._is_free = case.kind.endswith("wall"), case.kind.startswith("free")
        self._allowed = self._tolerance * self._law.strength

    def errors(self, state: xr.Dataset, place: int) -> dict[str, float]:
        """Return the errors of one state."""
        gap, traction = state.normal_gap.values, state.normal_traction.values
        if not (np.isfinite(gap).all() and np.isfinite(traction).all()):
            return {"finite": math.inf}
        approach, step, law = float(state.approach), self._scene.path.steps[place], self._law
        is_interpolated = int(state.status) == cs.Status.INTERPOLATED.value[0]
        allowed = float(state.residual) * law.strength if is_interpolated else self._allowed
        size = abs(approach) + np.abs(self._heights).max() + np.abs(gap).max() + law.normal_length
        errors, unbalanced = self._law_errors(gap, traction, allowed), 0.0
        if step.normal.control.name == "MEAN_PRESSURE":
            unbalanced = abs(traction.mean() + step.normal.value)  # a part of the residual at each point
            errors["load"] = unbalanced / (self._allowed + ROUNDING * (abs(step.normal.value) + law.strength))
        else:
            errors["prescribed approach"] = abs(approach - step.normal.value) / (ROUNDING * size)
        off = gap + self._heights + approach + self.displacement(traction)
        may_be = allowed + unbalanced + ROUNDING * self._stiffest * size + 1e-12 * law.strength
        residual, held = self._residual(off)
        errors["equilibrium"] = float(np.abs(residual).max() / may_be)
        errors["mean gap"] = held / (ROUNDING * size)
        told = state.get("normal_displacement")
        if told is not None:
            moved = np.abs(told.values - self.displacement(traction))
            errors["displacement"] = float(moved.max() / (self._softest * allowed + ROUNDING * size))
        return errors

    def _law_errors(self, gap: Array, traction: Array, allowed: float) -> dict[str, float]:
        """Return the errors of traction and gap, one of which a wall prescribes."""
        law = self._law
        own = self.traction(gap)
        if not self._has_wall:
            within = gap >= -10 * law.normal_length  # deeper, laws are continued by their tangents
            size = np.abs(own).max(where=within, initial=0) + law.strength
            return {"law": float(np.abs(traction - own).max(where=within, initial=0) / (ROUNDING * size))}
        pressure, length = own - traction, max(self._tolerance, allowed / law.strength) * law.interaction_range
        rounding = ROUNDING * (np.abs(traction).max() + law.strength)
        return {
            "overlap": float(max(-gap.min(), 0) / (length + ROUNDING * law.normal_length)),
            "pull of the wall": float(max(-pressure.min(), 0) / (rounding + allowed)),
            "pressure at a gap": float(
                np.abs(gap).max(where=pressure > allowed + rounding, initial=0)
                / (length + ROUNDING * law.normal_length)
            ),
        }

    def traction(self, gap: Array) -> Array:
        """Return the traction of the law, without the wall's."""
        law, name = self._law, type(self._law).__name__
        if name == "DugdaleAttraction":
            part = np.clip((gap / law.normal_length - 1) / law.ramp + 0.5, 0, 1)
            return law.work_of_separation / law.normal_length * (1 - 3 * part**2 + 2 * part**3)
        if name == "ExponentialAttraction":
            return law.work_of_separation / law.normal_length * np.exp(-np.maximum(gap, 0) / law.normal_length)
        return own_law(law)(gap, np.zeros_like(gap))[0]

    @cached_property
    def _compliance(self) -> Array:
        """Displacement of each wave, or of the points under a unit on one of them (free), nm/GPa."""
        shape, lengths = self._heights.shape, self._scene.lengths
        if self._is_free:
            return sum(1 / body[1] for body in self._bodies) * love_matrix(shape, lengths)
        waves = [np.fft.fftfreq(size, step / size / (2 * np.pi)) for size, step in zip(shape, lengths, strict=True)]
        waves[-1] = np.abs(waves[-1][: shape[-1] // 2 + 1])
        q = waves[0] if len(shape) == 1 else np.hypot(waves[0][:, None], waves[1])
        total = np.zeros_like(q)
        for kind, modulus, ratio, thickness, _ in self._bodies:
            shear, depth = modulus * (1 - ratio) / 2, thickness if kind == "layer" else np.inf
            moved = q > 0
            total[moved] += layer_compliance(q[moved] * depth, ratio)[0] / (shear * q[moved])
            total[~moved] += thickness * (1 - 2 * ratio) / (modulus * (1 - ratio) ** 2) if kind == "layer" else 0.0
        return total

    @cached_property
    def _inverse(self) -> Array:
        """Inverse of the compliance of free points."""
        return np.linalg.inv(self._compliance)

    @property
    def _stiffest(self) -> float:
        """Stiffness of the stiffest wave, GPa/nm."""
        if self._is_free:
            return 1 / (self._compliance[0, 0] * 0.2)
        return float(1 / self._compliance[self._compliance > 0].min())

    @property
    def _softest(self) -> float:
        """Displacement under a residual of 1 GPa of the worst pattern, nm/GPa."""
        if self._is_free:
            return float(self._compliance.sum(1).max())
        return float(np.abs(irfftn(self._compliance, self._heights.shape)).sum())

    def displacement(self, traction: Array) -> Array:
        """Return how far a traction moves the surface, nm."""
        if self._is_free:
            return (self._compliance @ traction.ravel()).reshape(traction.shape)
        return irfftn(self._compliance * rfftn(traction), traction.shape)

    def _residual(self, off: Array) -> tuple[Array, float]:
        """Return the traction that is out of balance, and how far a held mean is off."""
        if self._is_free:
            return (self._inverse @ off.ravel()).reshape(off.shape), 0.0
        waves, compliance, held = rfftn(off), self._compliance, 0.0
        if compliance.flat[0] == 0:
            held, waves.flat[0] = abs(off.mean()), 0.0
        stiffness = np.divide(1, compliance, out=np.zeros_like(compliance), where=compliance > 0)
        return irfftn(stiffness * waves, off.shape), held

    def energy(self, state: xr.Dataset) -> float:
        """Return the energy of bodies and law per area, N/m, on the heights."""
        gap, traction, law = state.normal_gap.values, state.normal_traction.values, self._law
        elastic = 0.5 * float((traction * self.displacement(traction)).mean())
        far = max(gap.max(), 12 * law.normal_length)
        places = np.unique(np.concatenate((np.linspace(min(gap.min(), 0), 1.2 * law.normal_length, 20001), [far])))
        places = np.concatenate((places, np.geomspace(1.2 * law.normal_length, far, 4001)))
        places = np.unique(places)
        pull = self.traction(places)
        work = np.concatenate(([0], np.cumsum((pull[1:] + pull[:-1]) / 2 * np.diff(places))))
        return elastic + float(np.interp(gap, places, work - work[-1]).mean())

    def _wall_pressure(self, state: xr.Dataset) -> float:
        """Return the mean pressure of the wall, GPa, which is zero without one."""
        gap, traction = state.normal_gap.values, state.normal_traction.values
        return float(np.maximum(self.traction(gap) - traction, 0).mean()) if self._has_wall else 0.0

    def balance_errors(self, states: list[tuple[int, xr.Dataset]], jumps: Array) -> float:
        """Return the largest energy that a step without a jump gains or loses, over what a smooth motion may.

        The load may pass an extreme within a step; so it may change by as much as in a step beside it. Gaps in contact
        are as exact as the tolerance says, and the pressure of the wall works on what they are off.
        """
        worst, law = 0.0, self._law
        loads = [-float(state.normal_traction.mean()) for _, state in states]
        changes = np.abs(np.diff(loads, prepend=loads[:1], append=loads[-1:]))
        for count, ((first, before), (last, after)) in enumerate(itertools.pairwise(states)):
            if last != first + 1 or jumps[last] > 0 or any(int(part.status) for part in (before, after)):
                continue
            moved = float(after.approach - before.approach)
            released = (loads[count] + loads[count + 1]) / 2 * moved - (self.energy(after) - self.energy(before))
            length = MOTION * law.interaction_range + STEPS * abs(moved)
            may_be = changes[count : count + 3].max() * abs(moved)
            may_be += 2 * self._tolerance * law.strength * (abs(moved) + length)
            may_be += self._tolerance * law.interaction_range * sum(map(self._wall_pressure, (before, after)))
            may_be += 1e-6 * law.strength * law.normal_length
            worst = max(worst, (-released if released < 0 else released - law.strength * length) / may_be)
        return worst


def love_matrix(shape: tuple[int, ...], lengths: tuple[float, ...]) -> Array:
    """Return the displacement at all points under a unit pressure on each element, for an E* of 1 GPa (n, n).

    References
    ----------
    A. E. H. Love, Phil. Trans. R. Soc. A 228, 377 (1929).
    """
    dy, dx = (length / size for length, size in zip(lengths, shape, strict=True))
    y, x = np.arange(shape[0])[:, None] * dy, np.arange(shape[1]) * dx

    def corner(y: Array, x: Array) -> Array:
        """Return the potential of a quarter-plane's corner."""
        far = np.hypot(y, x)
        return y * np.log(x + far) + x * np.log(y + far)

    a, b = dy / 2, dx / 2
    response = corner(y + a, x + b) - corner(y - a, x + b) - corner(y + a, x - b) + corner(y - a, x - b)
    row, column = (place.ravel() for place in np.indices(shape))
    apart = np.abs(row[:, None] - row), np.abs(column[:, None] - column)
    return response[apart] / np.pi


class Endless(Exception):  # noqa: N818 - no error of the program
    """A scene takes too long."""


def _end(*_: object) -> None:
    """Interrupt a scene."""
    raise Endless


def judge(number: int, seed: int) -> tuple[str, str, float, str]:
    """Return the kind of a scene, the verdict, the seconds, and what there is to tell."""
    case = draw_case(number, seed)
    begin = time.process_time()
    signal.signal(signal.SIGPROF, _end)
    signal.setitimer(signal.ITIMER_PROF, SECONDS)  # of a core: other processes do not count
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", RuntimeWarning)
            data = cs.simulate(case.scene, **case.options)
    except Endless:
        return case.kind, "without end", time.process_time() - begin, case.words
    except cs.InputError as error:
        return case.kind, "refused", 0.0, str(error)[:160]
    except Exception as error:  # whatever it is, it is wrong
        return case.kind, "wrong", 0.0, f"{type(error).__name__}: {error}; {case.words}"[:300]
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
    seconds = time.process_time() - begin
    wrong = {name: value for name, value in errors_of(case, data).items() if not value <= LIMIT}
    if wrong:
        return case.kind, "wrong", seconds, f"{wrong}; {case.words}"
    told = [cs.Status(status).sentence for status in _unsolved(case, data)]
    return case.kind, "told" if told else "right", seconds, f"{'; '.join(told)}; {case.words}"


def _unsolved(case: Case, data: xr.Dataset) -> list[Any]:
    """Return each status that says that a state, which there is, was not found."""
    by_number = {status.value[0]: status for status in cs.Status}
    found = [by_number[int(number)] for number in data.status.values]
    ends = [
        (place, status)
        for place, status in enumerate(found)
        if status.name == "UNLOCATED" or not (status.solved or status.name == "SKIPPED")
    ]
    missing = []
    for place, status in ends:
        normal = case.scene.path.steps[place].normal
        parted = status.name == "NO_EQUILIBRIUM" and (normal.control.name == "APPROACH" or normal.value < 0)
        if not parted and status not in missing:
            missing.append(status)
    return missing


def errors_of(case: Case, data: xr.Dataset) -> dict[str, float]:
    """Return the largest error of each kind of a scene."""
    worst: dict[str, float] = {}
    states = list(solved_states(case, data))
    coupled = case.kind == "line, coupled"
    is_plain = case.kind.startswith("line") and not case.kind.endswith("wall")
    equations = Equations(case.scene, case.bodies, case.options["points"], case.options["tolerance"])
    own = Judge(case, data)
    for place, state in states:
        errors = {} if coupled else own.errors(state, place)
        if is_plain:
            errors |= {f"{name} (2)": error for name, error in equations.judge(state, place, own._heights).items()}
        for name, error in errors.items():
            worst[name] = max(worst.get(name, 0.0), float(error)) if error == error else math.inf
    if not coupled:
        worst["energy"] = own.balance_errors(states, data.jump.values)
    return worst


def solved_states(case: Case, data: xr.Dataset) -> Iterator[tuple[int, xr.Dataset]]:
    """Yield the number of each step that is solved and kept, and its numbers and fields."""
    values = [step.value for step in case.scene.path.steps]
    kept = {values.index(value): count for count, value in enumerate(data.snapshot.values)}
    for place in sorted(kept):
        if place < data.sizes["step"] and int(data.status[place]) in SOLVED:
            yield place, data.isel(snapshot=kept[place], step=place)


def main() -> None:
    """Judge scenes, and write a table by kind."""
    on_one_thread()
    logging.getLogger("contactsim").setLevel(logging.ERROR)
    numbers = [int(word) for word in sys.argv[1:]]
    seed, count, first = (*numbers, *(SEED, COUNT, 0)[len(numbers) :])
    table: dict[str, Counter[str]] = {kind: Counter() for kind in KINDS}
    for number in range(first, first + count):
        kind, verdict, seconds, words = judge(number, seed)
        table[kind][verdict] += 1
        if verdict != "right" or seconds > SECONDS / 6:
            logger.info("%5d %-15s %-11s %5.1f s %s", number, kind, verdict, seconds, words)
    logger.info("%-16s%s", "kind", "".join(f"{verdict:>13}" for verdict in VERDICTS))
    for kind, found in (*table.items(), ("all", sum(table.values(), Counter()))):
        logger.info("%-16s%s", kind, "".join(f"{found[verdict]:13d}" for verdict in VERDICTS))


if __name__ == "__main__":
    main()
