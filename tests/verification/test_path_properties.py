"""What changes of a scene leave its path as it is: randomised, on paths that press and on slides."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest

from contactsim import (
    Body,
    CohesiveZone,
    Cylinder,
    Flat,
    FrictionalRepulsiveZone,
    HalfSpace,
    Layer,
    NormalCohesiveZone,
    Scene,
    StiffMixedZone,
    Topography,
    UncoupledCohesiveZone,
    approaches,
    pressures,
    simulate,
    sliding,
)

POINTS, TOLERANCE, NUMBERS = 96, 1e-10, range(6)


@dataclass(frozen=True)
class Setting:
    """A random scene in numbers, so that it can be changed."""

    heights: np.ndarray
    spacing: float
    law: object
    lower: object
    upper: object
    slides: bool
    reach: float
    begin: float
    deep: float
    steps: int = 8

    def path(self):
        if self.slides:
            return sliding([0.0, self.reach], self.reach / self.steps, approach=self.deep)
        return approaches(np.linspace(self.begin, self.deep, self.steps + 1))

    def simulate(self, path=None, is_turned=False):
        """Simulate; turned: the rough surface is the lower one."""
        surface = Topography(self.heights, spacing=self.spacing)
        flat = Flat.facing(surface)
        bodies = Body(surface if is_turned else flat, self.lower), Body(flat if is_turned else surface, self.upper)
        scene = Scene(*bodies, self.law, self.path() if path is None else path)
        values = sorted({step.value for step in scene.path.steps})
        return simulate(scene, points=self.heights.size, tolerance=TOLERANCE, snapshots=values)


def draw(number: int, slides: bool) -> Setting:
    """A random scene with a soft law, so that few states jump."""
    rng = np.random.default_rng([number, slides])
    waves = rng.normal(size=(2, 6)) / np.arange(1, 7)
    x = 2 * np.pi * np.arange(POINTS) / POINTS
    heights = sum(waves[0, k] * np.cos((k + 1) * x) + waves[1, k] * np.sin((k + 1) * x) for k in range(6))
    ratio, unit = rng.uniform(0.0, 0.5), 10.0 ** rng.uniform(-1, 3)
    bodies = HalfSpace(10.0, ratio), Layer(3.0, rng.uniform(0.0, 0.5), POINTS * unit * rng.uniform(0.1, 1.0)), None
    lower, upper = [(bodies[0], bodies[1]), (bodies[1], None), (None, bodies[0])][number % 3]
    stiffness = 0.3 * 2 * np.pi * 3.0 / (POINTS * unit)
    length = 0.5 * unit
    work = stiffness * length**2
    laws = [
        CohesiveZone(work, 0.5, length, 1.3 * length),
        UncoupledCohesiveZone(work, 0.5, length, length),
        FrictionalRepulsiveZone(work, 0.3, length, length),
        StiffMixedZone(work, 2 * stiffness, 0.5, length, length),
        CohesiveZone(work, 0.0, length, 1.3 * length),
        NormalCohesiveZone(work, length),
    ]
    law = laws[number] if not slides or number < 4 else laws[number - 4]
    heights = heights / heights.std() * 0.5 * unit
    touch = -heights.max()
    return Setting(heights, unit, law, lower, upper, slides, length, touch - 3 * length, touch + 2 * length)


def compare(one, other, length=1.0, pressure=1.0, places=slice(None), turned=1.0, within=1e-6):
    """Whether paths are the same, the second in other units, with its points elsewhere and forces along x turned."""
    assert (one.status == 0).all() and (other.status == 0).all()
    size = np.abs(one.normal_traction.values).max()
    gaps = one.normal_gap.values
    assert np.abs(other.normal_gap.values[:, places] / length - gaps).max() <= within * np.ptp(gaps)
    assert (
        np.abs(other.normal_traction.values[:, places] / pressure - one.normal_traction.values).max() <= within * size
    )
    assert np.abs(other.mean_pressure.values / pressure - one.mean_pressure.values).max() <= within * size
    if "tangential_traction" in one:
        shear = turned * other.tangential_traction.values[:, places] / pressure
        assert np.abs(shear - one.tangential_traction.values).max() <= within * size


@pytest.fixture(scope="module", params=[(number, slides) for number in NUMBERS for slides in (False, True)])
def setting(request):
    return draw(*request.param)


@pytest.fixture(scope="module")
def plain(setting):
    return setting.simulate()


def in_units(body, length, modulus):
    if body is None:
        return None
    changes = {"contact_modulus": modulus * body.contact_modulus}
    if isinstance(body, Layer):
        changes["thickness"] = length * body.thickness
    return replace(body, **changes)


@pytest.mark.parametrize(("length", "modulus"), [(1e-3, 1.0), (1.0, 1e3), (700.0, 0.03)])
def test_units_do_not_matter(setting, plain, length, modulus):
    law = setting.law
    names = {"work_of_separation": length * modulus, "contact_stiffness": modulus / length}
    names |= {"normal_length": length, "tangential_length": length}
    changed = replace(law, **{name: factor * getattr(law, name) for name, factor in names.items() if name in vars(law)})
    bodies = {side: in_units(getattr(setting, side), length, modulus) for side in ("lower", "upper")}
    numbers = {name: length * getattr(setting, name) for name in ("heights", "spacing", "reach", "begin", "deep")}
    compare(plain, replace(setting, law=changed, **bodies, **numbers).simulate(), length, modulus)


def test_a_mirrored_scene_has_the_mirrored_path(setting, plain):
    mirror = -np.arange(POINTS) % POINTS
    other = replace(setting, heights=setting.heights[mirror], reach=-setting.reach)
    path = (
        sliding([0.0, -setting.reach], setting.reach / setting.steps, approach=setting.deep) if setting.slides else None
    )
    compare(plain, other.simulate(path), places=mirror, turned=-1.0)


def test_a_surface_that_is_moved_by_a_point_has_the_moved_path(setting, plain):
    moved = replace(setting, heights=np.roll(setting.heights, 1))
    compare(plain, moved.simulate(), places=(np.arange(POINTS) + 1) % POINTS)


def test_a_scene_turned_upside_down_has_the_same_path(setting, plain):
    around = -np.arange(POINTS) % POINTS  # half a turn about the axis across: along x, too
    other = replace(setting, heights=setting.heights[around], lower=setting.upper, upper=setting.lower)
    compare(plain, other.simulate(is_turned=True), places=around)


def test_two_half_steps_are_one(setting, plain):
    halved = replace(setting, steps=2 * setting.steps).simulate()
    jumped = plain.jump.values.any() or halved.jump.values.any()
    compare(plain, halved.isel(snapshot=slice(0, None, 2), step=slice(0, None, 2)), within=1e-3 if jumped else 1e-6)


@pytest.mark.parametrize("number", NUMBERS)
def test_the_load_of_an_approach_leads_back_to_it(number):
    setting = draw(number, False)
    plain = setting.simulate()
    rises = np.flatnonzero(np.minimum.accumulate(np.diff(plain.mean_pressure.values)[::-1])[::-1] > 0) + 1
    loads = plain.mean_pressure.values[rises]
    assert len(rises) >= 3
    found = setting.simulate(pressures(loads.tolist()))
    assert (found.status == 0).all()
    assert np.abs(found.approach.values - plain.approach.values[rises]).max() < 1e-5 * setting.law.normal_length
    assert np.abs(found.mean_pressure.values - loads).max() <= 1e-8 * setting.law.strength


@pytest.mark.parametrize("slides", [False, True])
@pytest.mark.parametrize("work", [1e-6, 1e-12, 1e-18, 1e-30])
def test_bodies_far_stiffer_than_the_law_carry_a_load_as_rigid_ones(work, slides):
    law, surface = CohesiveZone(work, 0.5, 1.0, 1.0), Cylinder(radius=1000.0, length=200.0)
    path = sliding([0.0, 1.0], 0.25, mean_pressure=0.1 * work) if slides else pressures([0.01 * work, 0.2 * work])
    scene = Scene(Body(Flat.facing(surface)), Body(surface, HalfSpace(1e4, 0.3)), law, path)
    data = simulate(scene, points=128, tolerance=1e-9)
    assert (data.status == 0).all()
    for place, step in enumerate(path.steps):
        gap = -surface.heights(128) - float(data.approach[place])
        traction = law.traction(np.stack([gap, np.full(128, step.sliding_distance)]))[0]
        assert -traction.mean() == pytest.approx(step.normal.value, rel=1e-5)
    assert data.transforms.sum() < 400 * len(path.steps)
