"""Random paths of smooth laws, each state judged by equations that are written once more (`path_equations`).

    python benchmarks/random_paths.py [COUNT [FIRST]]    # 3000 scenes by default, on all cores: an hour
    python benchmarks/random_paths.py --large [COUNT [FIRST]]    # 100 by default, on 1024 and 2048 points

On large grids all eigenvalues are computed at two states of each scene.
Bodies, surfaces, laws, lattices, paths, increments, tolerances and grids are drawn at random, each scene from its
number. What is wrong with a scene is written with its number.
"""

from __future__ import annotations

import logging
import math
import multiprocessing
import os
import sys
import time
import warnings
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

import numpy as np
import xarray as xr
from path_equations import Bodies, Equations, State
from records import on_one_thread

import contactsim as cs
from contactsim.grid import Array

COUNT, LARGE_COUNT, BUDGET, SLIP_BUDGET = 3000, 100, 60.0, 0.5
"""Scenes, those on large grids, and CPU seconds after which a scene is endless: in all, and more for each slip."""
GRIDS, LARGE_GRIDS = (64, 81, 100, 128, 200, 256, 512), (1024, 2048)
"""Points of a scene."""
LARGE_ZONE = 1024
"""Points of a process zone that is large."""
LIMIT = 1.001
"""Error, over what it may be, from which it is told."""

logger = logging.getLogger("random_paths")


@dataclass(frozen=True)
class Case:
    """A random scene, its elastic bodies, and how it is followed."""

    scene: cs.Scene
    bodies: Bodies
    options: dict[str, Any]

    @cached_property
    def equations(self) -> Equations:
        """What its states must fulfil."""
        return Equations(self.scene, self.bodies, self.options["points"], self.options["tolerance"])

    @property
    def words(self) -> str:
        """The scene in a few words."""
        path, options = self.scene.path, self.options
        return (
            f"{type(self.scene.laws[0]).__name__}, {'+'.join(body[0] for body in self.bodies)}, "
            f"{type(self.scene.upper.surface).__name__}, {type(self.scene.pairing).__name__}, "
            f"{path.steps[-1].control.name.lower()}/{path.steps[-1].normal.control.name.lower()}, "
            f"{type(options['increments']).__name__}, {options['points']} points, tolerance {options['tolerance']:.1e}"
        )


class Draw:
    """Random choices of a scene."""

    def __init__(self, number: int, seed: int = 20261125) -> None:
        self._random = np.random.default_rng([number, seed])

    def between(self, least: float, most: float) -> float:
        """Return a number between two."""
        return float(self._random.uniform(least, most))

    def power(self, least: float, most: float) -> float:
        """Return a power of ten with an exponent between two."""
        return 10.0 ** self.between(least, most)

    def one_of(self, *values: Any) -> Any:
        """Return one of some values."""
        return values[int(self._random.integers(len(values)))]

    def chance(self, share: float) -> bool:
        """Return True with a probability."""
        return bool(self._random.random() < share)

    def noise(self, points: int, waves: int) -> Array:
        """Return a smooth random profile of zero mean and unit rms."""
        coefficients = np.zeros(points // 2 + 1, complex)
        coefficients[1 : waves + 1] = self._random.normal(size=waves) + 1j * self._random.normal(size=waves)
        values = np.fft.irfft(coefficients, points)
        return values / values.std()


def draw_case(number: int, grids: tuple[int, ...] = GRIDS) -> Case:
    """Return the random scene of a number."""
    draw = Draw(number)
    points = draw.one_of(*grids)
    length, normal_length = draw.power(0, 5), 1.0
    normal_length = length * draw.power(-4, -1.5)
    height = normal_length * draw.power(-1, 1.3)
    surface = draw_surface(draw, points, length, height)
    lattice = draw.chance(0.15)
    bodies = [draw_body(draw, length, 1)] if lattice else draw_bodies(draw, length)
    modulus = 1 / sum(1 / body[1] for body in bodies)
    stiffness = modulus * 2 * np.pi / length * draw.power(-1, 2.5)
    law = draw_law(draw, stiffness, normal_length)
    pairing = draw_lattice(draw, law, length) if lattice else None
    path = draw_path(draw, law, modulus, normal_length, height, surface, points)
    elastic = {side: elasticity(*rest) for *rest, side in bodies}
    lower = cs.Body(cs.Flat.facing(surface), elastic.get(0))
    path = pulled_off(path, law, number)
    scene = cs.Scene(lower, cs.Body(surface, elastic.get(1)), law, path, *([pairing] if pairing else []))
    options = {
        "points": points,
        "tolerance": draw.power(-8, -2),
        "increments": draw_increments(draw, path, normal_length, points),
        "snapshots": sorted({round(step.value, 12) for step in path.steps}),
    }
    return Case(scene, bodies, options)


def draw_surface(draw: Draw, points: int, length: float, height: float) -> Any:
    """Return a surface of about that height."""
    kind = draw.one_of("cylinder", "sinusoid", "rough", "measured", "flat")
    if kind == "cylinder":
        return cs.Cylinder(radius=length**2 / 8 / height, length=length)
    if kind == "sinusoid":
        return cs.Sinusoid(amplitude=height, length=length, periods=draw.one_of(1, 2, 3))
    if kind == "flat":
        return cs.Flat(length=length)
    if kind == "measured":
        values = height * draw.noise(points, draw.one_of(3, 8, points // 4))
        if draw.chance(0.5):
            values += height * draw.power(-1, 1) * np.cos(2 * np.pi * np.arange(points) / points)
        return cs.Topography(values, (length / points,))
    return cs.SelfAffine(
        length, draw.between(0.1, 0.9), long_cutoff=length / draw.one_of(1, 2, 4), short_cutoff=length / points * 4,
        rms_height=height, seed=draw.one_of(*range(1000)),
    )  # fmt: skip


def draw_body(draw: Draw, length: float, side: int) -> tuple[str, float, float, float, int]:
    """Return kind, contact modulus, Poisson's ratio, thickness and side (0 lower, 1 upper) of an elastic body."""
    ratio = draw.one_of(0.0, 0.3, 0.45, 0.499, 0.5, -0.9, draw.between(-0.99, 0.5))
    thickness = length * draw.power(-2, 1)
    return draw.one_of("half_space", "layer"), draw.power(-3, 3), ratio, thickness, side


def draw_bodies(draw: Draw, length: float) -> list[tuple[str, float, float, float, int]]:
    """Return one elastic body, or two."""
    sides = draw.one_of([0], [1], [0, 1])
    return [draw_body(draw, length, side) for side in sides]


def elasticity(kind: str, modulus: float, ratio: float, thickness: float) -> Any:
    """Return an elastic body."""
    return cs.HalfSpace(modulus, ratio) if kind == "half_space" else cs.Layer(modulus, ratio, thickness)


def draw_law(draw: Draw, stiffness: float, normal_length: float) -> Any:
    """Return a law of a stiffness at zero gap."""
    work, tangential = stiffness * normal_length**2, normal_length * draw.power(-0.7, 0.7)
    ratio = draw.one_of(0.0, 0.1, 0.5, 1.0, 2.0)
    kind = draw.one_of("normal", "mixed", "mixed", "uncoupled", "repulsive", "stiff", "frictional", "stiff_mixed")
    wall = stiffness * draw.power(-0.5, 1)
    if kind == "normal":
        return cs.NormalCohesiveZone(work, normal_length)
    if kind == "mixed":
        return cs.CohesiveZone(work, ratio, normal_length, tangential)
    if kind == "uncoupled":
        return cs.UncoupledCohesiveZone(work, ratio or 0.3, normal_length, tangential)
    if kind == "repulsive":
        return cs.RepulsiveZone(work, normal_length)
    if kind == "stiff":
        return cs.StiffCohesiveZone(work, wall, normal_length)
    if kind == "frictional":
        return cs.FrictionalRepulsiveZone(work, draw.one_of(0.0, 0.3, 1.0), normal_length, tangential)
    return cs.StiffMixedZone(work, wall, ratio, normal_length, tangential)


def draw_lattice(draw: Draw, law: Any, length: float) -> cs.Lattice:
    """Return springs between the sites of two lattices, a whole number of which fits the period."""
    unit = law.tangential_length if math.isfinite(law.tangential_length) else law.normal_length
    count = max(round(length / (unit * draw.power(-0.2, 0.8))), 1)
    return cs.Lattice(length / count, tangential_cutoff=draw.one_of(2.0, 5.0))


def draw_path(
    draw: Draw, law: Any, modulus: float, unit: float, height: float, surface: Any, points: int
) -> cs.LoadPath:
    """Return a path that presses, pulls off or slides."""
    touch = -float(surface.heights(points).max())
    deep = touch + unit * draw.power(-0.5, 0.7) + height * draw.between(0, 1.5)
    begin = touch - unit * draw.between(0.5, 6)
    count = draw.one_of(5, 12, 20)
    control = draw.one_of("approach", "approach", "pressure", "slide", "held pressure")
    slides = "t" in law.reads and control in ("slide", "held pressure")
    span = modulus * height * 2 * np.pi / surface.lengths[0]
    pressure = min(span, 0.5 * law.stiffness * unit) * draw.power(-2, 0)
    if slides:
        reach = getattr(law, "tangential_length", unit) * draw.power(-0.5, 1)
        held = {"approach": deep} if control == "slide" else {"mean_pressure": pressure}
        return cs.sliding([0.0, reach], reach / count, **held)
    if control in ("pressure", "held pressure"):
        return cs.pressures([pressure * share for share in np.linspace(0.05, 1, count)])
    if draw.chance(0.5):
        return cs.approaches([begin, deep], (deep - begin) / count)
    return cs.approaches([begin, deep, begin - (deep - begin) * 0.437], (deep - begin) / count)


def pulled_off(path: cs.LoadPath, law: Any, number: int) -> cs.LoadPath:
    """Return a path under loads, now and then followed by growing pulls until the bodies part, or not."""
    draw = Draw(number, seed=20261126)
    pulls = "Repulsive" not in type(law).__name__
    if not pulls or path.steps[-1].control.name != "MEAN_PRESSURE" or draw.chance(0.5):
        return path
    pull = law.strength * draw.power(-2.5, -0.2)
    return path >> cs.pressures([-pull * share for share in np.linspace(0, 1, 12)])


def draw_increments(draw: Draw, path: cs.LoadPath, unit: float, points: int) -> Any:
    """Return how the path is followed."""
    values = [step.value for step in path.steps]
    reach = max(values) - min(values)
    kind = draw.one_of("requested", "requested", "adaptive", "nested")
    if kind == "adaptive":
        return cs.Adaptive(error=unit * draw.power(-3, -1.5), least=reach / 1000, most=reach / 2)
    nests = points % 16 == 0 and len(set(values)) > 2 and not path.slides
    if kind == "nested" and nests:
        return cs.Nested(full_grid_at=[values[len(values) // 2], values[-1]])
    return cs.Requested()


def judge(number: int, grids: tuple[int, ...] = GRIDS) -> list[tuple[int, str, float, str]]:
    """Return what is wrong with a scene: its number, what, by how much, and where; one row if nothing is."""
    begin, worst = time.process_time(), {}
    try:
        case = draw_case(number, grids)
        with warnings.catch_warnings():
            warnings.simplefilter("error", RuntimeWarning)
            data = cs.simulate(case.scene, **case.options)
    except cs.InputError as error:
        return [(number, "refused", 0.0, str(error)[:160])]
    except Exception as error:  # whatever it is, it is told
        return [(number, "crashed", math.inf, f"{type(error).__name__}: {error}"[:160])]
    seconds, solved = time.process_time() - begin, 0
    if seconds > BUDGET + SLIP_BUDGET * data.sizes.get("event", 0):
        worst["endless"] = number, "endless", seconds, case.words
    states = list(solved_states(case, data))
    looked_at = {len(states) // 2, len(states) - 1} if grids == LARGE_GRIDS else None
    for place, state in states:
        looks = None if looked_at is None else solved in looked_at
        solved += 1
        for name, error in case.equations.judge(state, place, data.heights.values, looks).items():
            if not error <= LIMIT and (name not in worst or error > worst[name][2]):
                worst[name] = number, name, float(error), f"step {place}; {case.words}"
    unsolved = len(case.scene.path.steps) - solved
    right = "right, some unsolved" if unsolved else "right"
    if looked_at is not None and states:
        place, state = states[-1]
        zone = State(case.equations, state, case.scene.path.steps[place], data.heights.values).zone()
        right += f", {'large' if zone >= LARGE_ZONE else 'smaller'} zone"
    return list(worst.values()) or [(number, right, seconds, f"{solved} states")]


def solved_states(case: Case, data: xr.Dataset) -> Iterator[tuple[int, xr.Dataset]]:
    """Yield the number of each step that is solved on the whole grid, and its numbers and fields."""
    values = [step.value for step in case.scene.path.steps]
    for count, value in enumerate(data.snapshot.values):
        place = values.index(value)
        if place < data.sizes["step"]:
            state = data.isel(snapshot=count, step=place)
            if int(state.status) in SOLVED and int(state.solved_points) == data.heights.size:
                yield place, state


SOLVED = {status.value[0] for status in cs.Status if status.solved}


def main() -> None:
    """Judge many scenes and write what was found."""
    on_one_thread()
    logging.getLogger("contactsim").setLevel(logging.ERROR)
    is_large = "--large" in sys.argv
    numbers = [int(word) for word in sys.argv[1:] if word != "--large"]
    count, first = (*numbers, *(LARGE_COUNT if is_large else COUNT, 0)[len(numbers) :])
    found: Counter[str] = Counter()
    with multiprocessing.Pool(os.cpu_count()) as pool:
        judge_one = partial(judge, grids=LARGE_GRIDS) if is_large else judge
        for rows in pool.imap_unordered(judge_one, range(first, first + count)):
            for number, name, error, words in rows:
                found[name] += 1
                if not name.startswith("right"):
                    logger.info("%5d %-20s %9.2e %s", number, name, error, words)
    logger.info("%s", dict(found))


if __name__ == "__main__":
    main()
