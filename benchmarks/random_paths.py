"""Random paths of smooth laws, each state judged by equations that are written once more here.

    python benchmarks/random_paths.py [COUNT [FIRST]]    # 3000 scenes by default, on all cores

Bodies, surfaces, laws, lattices, paths, increments, tolerances and grids are drawn at random, each scene from its
number. Of a state that is called converged, the gap and the traction are taken, and nothing else. The traction must be
that of the law at the gap. The gap must be that of the undeformed surfaces and of the displacement that the traction
causes, to the tolerance or, of an interpolated state, to its stated residual. Prescribed approach, mean pressure and sliding distance must be there. Where the law has a
potential, no displacement may lower the energy; elsewhere, none may grow on its own. What is not so, is written with the number of its scene.
"""

from __future__ import annotations

import itertools
import logging
import math
import multiprocessing
import os
import sys
import time
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import xarray as xr
from records import on_one_thread

import contactsim as cs
from contactsim.grid import Array

COUNT, BUDGET = 3000, 60.0
"""Scenes, and CPU seconds after which a scene counts as endless."""
ROUNDING = 1e-9
"""What rounding may add to an error, over the size of what is compared."""
GROWTH = 1e-3
"""Largest rate, over the law's largest tangent, at which a displacement may grow at a stable state."""
STABILITY_POINTS = {True: 512, False: 128}
"""Points up to which the whole stiffness is looked at, of laws with a potential and of others."""
BEYOND = -10.0
"""Overlap, in the law's lengths, from which laws are continued by their tangents."""

logger = logging.getLogger("random_paths")


@dataclass(frozen=True)
class Case:
    """A random scene, how it is followed, and what its equations need."""

    scene: cs.Scene
    options: dict[str, Any]
    law: Callable[[Array, Array], tuple[Array, Array]]
    strength: float
    stiffness: float
    has_potential: bool
    exerts_shear: bool
    bodies: list[tuple[str, float, float, float, int]] = field(default_factory=list)


class Draw:
    """Random choices of a scene."""

    def __init__(self, number: int) -> None:
        self._random = np.random.default_rng([number, 20261125])

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


def draw_case(number: int) -> Case:
    """Return the random scene of a number."""
    draw = Draw(number)
    points = draw.one_of(64, 81, 100, 128, 200, 256, 512)
    length, normal_length = draw.power(0, 5), 1.0
    normal_length = length * draw.power(-4, -1.5)
    height = normal_length * draw.power(-1, 1.3)
    surface, points = draw_surface(draw, points, length, height)
    lattice = draw.chance(0.15)
    bodies = [draw_body(draw, length, 1)] if lattice else draw_bodies(draw, length)
    modulus = 1 / sum(1 / body[1] for body in bodies)
    stiffness = modulus * 2 * np.pi / length * draw.power(-1, 2.5)
    law = draw_law(draw, stiffness, normal_length)
    pairing = draw_lattice(draw, law, length) if lattice else None
    path, steps = draw_path(draw, law, modulus, normal_length, height, surface, points, pairing)
    elastic = {side: elasticity(*rest) for *rest, side in bodies}
    lower = cs.Body(cs.Flat.facing(surface), elastic.get(0))
    scene = cs.Scene(lower, cs.Body(surface, elastic.get(1)), law, path, *([pairing] if pairing else []))
    options = {
        "points": points,
        "tolerance": draw.power(-8, -2),
        "increments": draw_increments(draw, path, normal_length, points),
        "snapshots": sorted({round(step.value, 12) for step in steps}),
    }
    equations, potential, shear = own_law(law, pairing)
    interface = scene.pairing.join(law, np.zeros(points), length)  # strength and stiffness are units here
    return Case(scene, options, equations, interface.strength, interface.stiffness, potential, shear, bodies)


def draw_surface(draw: Draw, points: int, length: float, height: float) -> tuple[Any, int]:
    """Return a surface of about that height, and the points of its grid."""
    kind = draw.one_of("cylinder", "sinusoid", "rough", "measured", "flat")
    if kind == "cylinder":
        return cs.Cylinder(radius=length**2 / 8 / height, length=length), points
    if kind == "sinusoid":
        return cs.Sinusoid(amplitude=height, length=length, periods=draw.one_of(1, 2, 3)), points
    if kind == "flat":
        return cs.Flat(length=length), points
    if kind == "measured":
        values = height * draw.noise(points, draw.one_of(3, 8, points // 4))
        if draw.chance(0.5):
            values += height * draw.power(-1, 1) * np.cos(2 * np.pi * np.arange(points) / points)
        return cs.Topography(values, (length / points,)), points
    return cs.SelfAffine(
        length, draw.between(0.1, 0.9), long_cutoff=length / draw.one_of(1, 2, 4), short_cutoff=length / points * 4,
        rms_height=height, seed=draw.one_of(*range(1000)),
    ), points  # fmt: skip


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
    draw: Draw, law: Any, modulus: float, unit: float, height: float, surface: Any, points: int, pairing: Any
) -> tuple[cs.LoadPath, list[Any]]:
    """Return a path, and those of its steps that are judged."""
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
        path = cs.sliding([0.0, reach], reach / count, **held)
    elif control in ("pressure", "held pressure"):
        path = cs.pressures([pressure * share for share in np.linspace(0.05, 1, count)])
    elif draw.chance(0.5):
        path = cs.approaches([begin, deep], (deep - begin) / count)
    else:
        path = cs.approaches([begin, deep, begin - (deep - begin) * 0.437], (deep - begin) / count)
    return path, list(path.steps)


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


# The equations, once more.


def own_law(law: Any, pairing: Any) -> tuple[Callable[[Array, Array], tuple[Array, Array]], bool, bool]:
    """Return the tractions (normal, tangential) as a function of both gaps; whether it has a potential, and shear."""
    name, unit = type(law).__name__, law.normal_length
    work, across = law.work_of_separation, getattr(law, "tangential_length", math.inf)
    ratio = getattr(law, "work_ratio", 0.0)
    wall = getattr(law, "contact_stiffness", work / unit**2)
    friction = getattr(law, "friction_coefficient", 0.0)

    def bare(normal: Array, slip: Array) -> tuple[Array, Array]:
        y, t = normal / unit, slip / across
        pull = work / unit * y * np.exp(-y)
        shear = 2 * ratio * work / across * t * np.exp(-y - t**2) if ratio else np.zeros_like(y)
        if name == "CohesiveZone":
            pull = pull * np.exp(-(t**2))
        if name in ("RepulsiveZone", "FrictionalRepulsiveZone"):
            pull = np.where(y < 0, pull, 0.0)
        if name == "FrictionalRepulsiveZone":
            shear = -pull * friction * math.sqrt(2 * math.e) * t * np.exp(-(t**2))
        if name in ("StiffCohesiveZone", "StiffMixedZone"):
            push = wall * normal * np.exp(-y)
            pull = np.where(y < 0, push, pull * (np.exp(-(t**2)) if name == "StiffMixedZone" else 1.0))
        return pull, shear

    def springs(normal: Array, slip: Array) -> tuple[Array, Array]:
        reach = across if math.isfinite(across) else unit
        sites = math.ceil(pairing.tangential_cutoff * reach / pairing.lattice_constant)
        nearest = np.rint(slip / pairing.lattice_constant)
        totals = np.zeros_like(normal), np.zeros_like(normal)
        for site in range(-sites, sites + 1):
            for total, part in zip(
                totals, bare(normal, slip - pairing.lattice_constant * (nearest + site)), strict=True
            ):
                total += part
        return totals

    potential = name in ("NormalCohesiveZone", "RepulsiveZone", "StiffCohesiveZone")
    return springs if pairing else bare, potential, bool(ratio or friction)


def compliance(case: Case, points: int) -> tuple[Array, Array, Array]:
    """Return what a traction on the lower surface moves it by, relative to the upper one: (nn, tt, nt) (m,), nm/GPa."""
    q = 2 * np.pi * np.arange(points // 2 + 1) / case.scene.length
    total = np.zeros((3, q.size))
    for kind, modulus, ratio, thickness, side in case.bodies:
        own = np.zeros((3, q.size))
        shear_modulus = modulus * (1 - ratio) / 2
        x = np.minimum(q[1:] * (thickness if kind == "layer" else np.inf), 300.0)
        own[:, 1:] = layer_compliance(x, ratio) / (shear_modulus * q[1:])
        if kind == "layer":
            uniaxial = modulus * (1 - ratio) ** 2 / (1 - 2 * ratio) if ratio < 0.5 else math.inf
            own[0, 0], own[1, 0] = thickness / uniaxial, thickness / shear_modulus
        total += own * np.array([1.0, 1.0, -1.0 if side else 1.0])[:, None]
    if points % 2 == 0:
        total[2, -1] = 0.0
    return total[0], total[1], total[2]


def layer_compliance(x: Array, ratio: float) -> Array:
    """Return the entries nn, tt and nt of the compliance of a bonded layer (3, m), over 1/(μq), at qh = x."""
    k = 3 - 4 * ratio
    with np.errstate(over="ignore"):
        deep = x > 20
        y = np.where(deep, 1.0, x)
        below = k * np.cosh(2 * y) + (1 + k**2) / 2 + 2 * y**2
        normal = (1 - ratio) * (k * np.sinh(2 * y) + (4 - 8 * ratio - 2 * k) * y) / below
        along = (1 - ratio) * (k * np.sinh(2 * y) + 2 * y) / below
        across = ((1 - 2 * ratio) * k * np.sinh(y) ** 2 - y**2) / below
    small = x < 1e-3  # k (sinh 2x - 2x) + 4 (1-2ν) x loses its digits
    series = (1 - ratio) * (k * (8 * x**3 / 6 + 32 * x**5 / 120) + (4 - 8 * ratio) * x) / below
    normal = np.where(small, series, normal)
    limit = [[1 - ratio], [1 - ratio], [0.5 - ratio]]
    return np.where(deep, limit, np.stack([normal, along, across]))


def judge_state(case: Case, state: xr.Dataset, heights: Array) -> dict[str, float]:
    """Return the errors of a state that is called converged, each over what it may be."""
    points, is_interpolated = heights.size, int(state.status) == cs.Status.INTERPOLATED.value[0]
    tolerance = float(state.residual) if is_interpolated else case.options["tolerance"]
    normal, pull = state.normal_gap.values, state.normal_traction.values
    has_slip, has_shear = "tangential_gap" in state, "tangential_traction" in state
    slip = state.tangential_gap.values if has_slip else np.zeros(points)
    shear = state.tangential_traction.values if has_shear else np.zeros(points)
    allowed = tolerance * case.strength
    errors: dict[str, float] = {}
    fields = (normal, slip, pull, shear)
    if not all(np.isfinite(values).all() for values in fields):
        return {"finite": math.inf}
    own_pull, own_shear = case.law(normal, slip)
    inside = normal >= BEYOND * case.scene.laws[0].normal_length
    for name, found, own in (("normal law", pull, own_pull), ("tangential law", shear, own_shear)):
        size = np.abs(own).max() + case.strength
        errors[name] = float(np.abs(found - own)[inside].max(initial=0.0) / size / ROUNDING)

    nn, tt, nt = compliance(case, points)
    pulls, shears = np.fft.rfft(pull), np.fft.rfft(shear)
    moved = np.fft.rfft(normal + heights)
    expected = -(nn * pulls + 1j * nt * shears)
    off_normal = moved - expected
    off_slip = np.fft.rfft(slip) - -(tt * shears - 1j * nt * pulls)
    if not has_slip:
        off_slip = np.zeros_like(off_slip)
    mean = float(moved[0].real) / points
    free = nn[0] * float(pulls[0].real) / points
    errors["approach"] = abs(mean + float(state.approach) + free) / (
        ROUNDING * (abs(mean) + abs(free) + np.abs(heights).max() + case.scene.laws[0].normal_length) + nn[0] * allowed
    )
    step = case.scene.path.steps[int(state.place)]
    held = step.normal
    if held.control.name == "MEAN_PRESSURE":
        errors["load"] = abs(float(pulls[0].real) / points + held.value) / (allowed + ROUNDING * held.value)
        off_normal[0] = 0.0
    else:
        errors["prescribed approach"] = abs(float(state.approach) - held.value) / (
            ROUNDING * max(abs(held.value), 1e-300)
        )
        off_normal[0] += points * held.value
    off_slip[0] -= points * step.sliding_distance
    for name, off, entry in (("normal", off_normal, nn), ("tangential", off_slip, tt)):
        if entry[0] == 0 and not (name == "normal" and held.control.name == "MEAN_PRESSURE"):
            size = case.scene.laws[0].normal_length + np.abs(normal).max() + np.abs(heights).max() + np.abs(slip).max()
            errors[f"{name} held mode"] = abs(off[0]) / points / (ROUNDING * size)
            off[0] = 0.0
    residual = residual_field(case, (nn, tt, nt), off_normal, off_slip, points)
    if held.control.name == "MEAN_PRESSURE":  # the law carries it
        residual[0] += float(pulls[0].real) / points + held.value
    largest = np.abs(residual).max()
    waves = np.where(nn > 0, nn, np.inf)
    rounding = 1e-14 * (np.abs(normal).max() + np.abs(heights).max()) / waves[1:].min() + 1e-13 * case.strength
    errors["equilibrium"] = float(largest / (allowed + 10 * rounding))
    if has_slip and not has_shear:  # a surface free of shear follows its normal traction
        size = np.abs(slip).max() + case.scene.laws[0].normal_length
        factor = np.divide(-nt, nn, out=np.zeros_like(nt), where=nn > 0)
        rest = np.fft.irfft(off_slip - 1j * factor * off_normal, points)
        errors["free slip"] = float(np.abs(rest).max() / (1e-7 * size))
    if points <= STABILITY_POINTS[case.has_potential] and inside.all():
        rate = softest(case, (normal, slip), (nn, tt, nt), held.control.name == "MEAN_PRESSURE")
        errors["stability"] = -rate / (GROWTH * case.stiffness)
    return errors


def residual_field(
    case: Case, entries: tuple[Array, Array, Array], off_normal: Array, off_slip: Array, points: int
) -> Array:
    """Return the traction that is out of balance at each point (1 or 2, n), GPa."""
    nn, tt, nt = entries
    if not case.exerts_shear:
        return np.fft.irfft(np.divide(off_normal, nn, out=np.zeros_like(off_normal), where=nn > 0), points)[None]
    below = nn * tt - nt**2
    both = (nn > 0) & (tt > 0)
    below = np.where(both, below, 1.0)
    normal = np.where(both, (tt * off_normal - 1j * nt * off_slip) / below, 0)
    along = np.where(both, (nn * off_slip + 1j * nt * off_normal) / below, 0)
    for out, off, entry in ((normal, off_normal, nn), (along, off_slip, tt)):
        alone = ~both & (entry > 0)
        out[alone] = off[alone] / entry[alone]
    return np.stack([np.fft.irfft(normal, points), np.fft.irfft(along, points)])


def softest(case: Case, state: tuple[Array, Array], entries: tuple[Array, Array, Array], under_load: bool) -> float:
    """Return the least rate (GPa/nm) at which a displacement decays; below zero it grows.

    K + D, with the derivative D of the law by finite differences, acts on the values at the points: one component or
    two. Held modes are out of the way.
    """
    (normal, slip), (nn, tt, nt) = state, entries
    points, size = normal.size, case.scene.laws[0].normal_length
    step, across = 1e-6 * size, 1e-6 * min(getattr(case.scene.laws[0], "tangential_length", size), size)
    stiffness = stiffness_matrices(nn, tt, nt, points, case.exerts_shear)
    by_normal = [
        (a - b) / (2 * step) for a, b in zip(case.law(normal + step, slip), case.law(normal - step, slip), strict=True)
    ]
    by_slip = [
        (a - b) / (2 * across)
        for a, b in zip(case.law(normal, slip + across), case.law(normal, slip - across), strict=True)
    ]
    if not case.exerts_shear:
        factor = np.divide(-1j * nt, nn, out=np.zeros_like(nt, complex), where=nn > 0)
        matrix = stiffness[0][0] + np.diag(by_normal[0])
        if not case.has_potential:
            matrix += by_slip[0][:, None] * operator(factor, points)
        blocks = [[matrix]]
        held = [nn[0] == 0 or under_load]
    else:
        blocks = [
            [stiffness[0][0] + np.diag(by_normal[0]), stiffness[0][1] + np.diag(by_slip[0])],
            [stiffness[1][0] + np.diag(by_normal[1]), stiffness[1][1] + np.diag(by_slip[1])],
        ]
        held = [nn[0] == 0 or under_load, tt[0] == 0]
    if under_load:  # the uniform mode of the gap is free
        blocks[0][0] = blocks[0][0] - (1 / nn[0] / points if nn[0] else 0.0)
        held[0] = False
    whole = np.block(blocks)
    for row, is_held in enumerate(held):
        if is_held:
            mean = np.zeros(len(whole))
            mean[row * points : (row + 1) * points] = points**-0.5
            away = np.eye(len(whole)) - np.outer(mean, mean)
            whole = away @ whole @ away + 10 * case.stiffness * np.outer(mean, mean)
    values = np.linalg.eigvalsh(whole) if case.has_potential else np.linalg.eigvals(whole).real
    return float(values.min())


def operator(symbol: Array, points: int) -> Array:
    """Return the matrix that multiplies the waves of values at the points by a symbol (m,)."""
    return np.fft.irfft(symbol[:, None] * np.fft.rfft(np.eye(points), axis=0), points, axis=0)


def stiffness_matrices(nn: Array, tt: Array, nt: Array, points: int, both: bool) -> list[list[Array]]:
    """Return the blocks of the stiffness, of the normal component alone or of both."""
    if not both:
        return [[operator(np.divide(1.0, nn, out=np.zeros_like(nn), where=nn > 0), points)]]
    moves = (nn > 0) & (tt > 0)
    below = np.where(moves, nn * tt - nt**2, 1.0)
    normal = np.where(moves, tt / below, np.where(nn > 0, 1 / np.where(nn > 0, nn, 1.0), 0.0))
    along = np.where(moves, nn / below, np.where(tt > 0, 1 / np.where(tt > 0, tt, 1.0), 0.0))
    cross = np.where(moves, -1j * nt / below, 0.0)
    return [[operator(normal, points), operator(cross, points)], [operator(-cross, points), operator(along, points)]]


def judge(number: int) -> list[tuple[int, str, float, str]]:
    """Return what is wrong with a scene: its number, what, by how much, and where; one row if nothing is."""
    begin, case, rows = time.process_time(), None, []
    try:
        case = draw_case(number)
        with warnings.catch_warnings():
            warnings.simplefilter("error", RuntimeWarning)
            data = cs.simulate(case.scene, **case.options)
    except cs.InputError as error:
        return [(number, "refused", 0.0, str(error)[:160])]
    except Exception as error:  # noqa: BLE001 - whatever it is, it is told
        return [(number, "crashed", math.inf, f"{type(error).__name__}: {error}"[:160])]
    seconds = time.process_time() - begin
    if seconds > BUDGET:
        rows.append((number, "endless", seconds, describe(case)))
    solved = 0
    for place, state in states(case, data):
        if int(state.status) not in SOLVED or int(state.solved_points) < data.heights.size:
            continue
        solved += 1
        state = state.assign(place=place)
        for name, error in judge_state(case, state, data.heights.values).items():
            if not error <= 1.001:
                rows.append((number, name, float(error), f"step {place}; {describe(case)}"))
    worst: dict[str, tuple[int, str, float, str]] = {}
    for row in rows:
        if row[1] not in worst or row[2] > worst[row[1]][2]:
            worst[row[1]] = row
    failed = len(case.scene.path.steps) - solved
    return list(worst.values()) or [(number, "right" if not failed else "right, some unsolved", seconds, f"{solved}")]


def states(case: Case, data: xr.Dataset) -> Iterator[tuple[int, xr.Dataset]]:
    """Yield the number of each step that kept its fields, and its numbers and fields."""
    values = [step.value for step in case.scene.path.steps]
    for count, value in enumerate(data.snapshot.values):
        place = next(index for index, own in enumerate(values) if own == value)
        if place < data.sizes["step"]:
            yield place, data.isel(snapshot=count, step=place)


def describe(case: Case) -> str:
    """Return a scene in a few words."""
    path, options = case.scene.path, case.options
    return (
        f"{type(case.scene.laws[0]).__name__}, {'+'.join(body[0] for body in case.bodies)}, "
        f"{type(case.scene.upper.surface).__name__}, {type(case.scene.pairing).__name__}, "
        f"{path.steps[-1].control.name.lower()}/{path.steps[-1].normal.control.name.lower()}, "
        f"{type(options['increments']).__name__}, {options['points']} points, tolerance {options['tolerance']:.1e}"
    )


SOLVED = {status.value[0] for status in cs.Status if status.solved}


def main() -> None:
    """Judge many scenes and write what was found."""
    on_one_thread()
    logging.getLogger("contactsim").setLevel(logging.ERROR)
    count = int(sys.argv[1]) if len(sys.argv) > 1 else COUNT
    first = int(sys.argv[2]) if len(sys.argv) > 2 else 0
    found: Counter[str] = Counter()
    with multiprocessing.Pool(os.cpu_count()) as pool:
        for rows in pool.imap_unordered(judge, range(first, first + count)):
            for number, name, error, words in rows:
                found[name] += 1
                if not name.startswith("right"):
                    logger.info("%5d %-20s %9.2e %s", number, name, error, words)
    logger.info("%s", dict(found))


if __name__ == "__main__":
    main()
