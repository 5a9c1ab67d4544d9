"""Whatever is given to a public call is used, or refused in one line that names the parameter."""

from __future__ import annotations

import inspect
import resource
import warnings

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.figure import Figure

import contactsim as cs
from contactsim.contact.pose_cohesive import pose_cohesive
from contactsim.solvers.cohesive.newton_krylov import NewtonKrylov

ODD = [
    "x", "", None, np.nan, np.inf, -1, 0, 2.0, 0.3, True, 1j, [], {}, (1, 2), ["a"], [0.01], object(), 10**9, b"x",
    "1%", "64", np.array([]), np.ones(3), np.ones((2, 2, 2)), [[1], [1, 2]], range, len, cs.Scene, 10**400,
]  # fmt: skip
MISSING = object()
MEMORY = 2 << 30
"""Bytes that all calls together may take."""

line = 5 * np.cos(np.arange(16) / 16 * 2 * np.pi)
body, law, cylinder = cs.HalfSpace(1.0, 0.3), cs.NormalCohesiveZone(1.0), cs.Cylinder(1000.0, 5000.0)
mixed, lattice = cs.CohesiveZone(0.5, 0.3), cs.Lattice(10.0)
path, topography = cs.pressures([0.01]), cs.Topography(line, (10.0,))
scene = cs.Scene(body, cylinder, cs.HardWall(), path)
cohesive = cs.Scene(body, cylinder, law, cs.approaches([-2.0, -1.0]))
pressed = cs.press(line, spacing=10.0, contact_modulus=1.0, mean_pressure=0.01, tolerance=1e-6)
characterised = cs.characterise(topography, contact_modulus=1.0, mean_pressures=[0.01])
LAW = {"work_of_separation": 0.5, "normal_length": 1.0}
MIXED = LAW | {"work_ratio": 0.3, "tangential_length": 1.0}
CALLS = {
    "press": {
        "heights": line, "other": None, "contact_modulus": 1.0, "mean_pressure": 0.01, "approach": None,
        "spacing": 10.0, "offset": None, "thickness": None, "poisson_ratio": None, "tolerance": 1e-3,
        "solver": None, "threads": 1, "periodic": None, "errors": False,
    },
    "characterise": {
        "topography": topography, "other": None, "contact_modulus": 1.0, "mean_pressures": [0.01], "offset": None,
        "hardness": None, "conductivities": None, "tolerance": 1e-3, "threads": 1, "periodic": None, "thickness": None,
        "poisson_ratio": None, "solver": None,
    },
    "contact_stiffness": {"result": pressed, "tolerance": 1e-6, "threads": 1},
    "conductance": {"stiffness": 1.0, "contact_modulus": 1.0, "conductivities": (1.0, 2.0)},
    "partial_slip": {
        "result": pressed, "shear_traction": 0.0001, "friction_coefficient": 0.3, "poisson_ratio": 0.3,
        "tolerance": 1e-6, "threads": 1,
    },
    "find_patches": {"contact": line > 0, "periodic": True},
    "simulate": {
        "scene": scene, "points": 16, "tolerance": 1e-3, "accuracy": None, "errors": False, "quantities": (),
        "solver": None,
        "increments": None, "snapshots": None, "keep": None, "keep_fields": None, "until": None, "threads": 1,
    },
    "estimate_cost": {
        "scene": scene, "points": 64, "tolerance": 1e-3, "accuracy": None, "quantities": (), "increments": None,
    },
    "neglect": {
        "scene": scene, "within": 0.1, "quantities": ["relative_contact_area"], "points": 64, "tolerance": 1e-3,
        "increments": None,
    },
    "explain": {"scene": scene, "points": 64, "solver": None, "increments": None},
    "Scene": {"lower": body, "upper": cylinder, "effects": cs.HardWall(), "path": path, "pairing": cs.Aligned()},
    "Body": {"surface": cylinder, "elasticity": body},
    "LoadPath": {"parts": path.parts, "from_touch": False},
    "pressures": {"values": [0.1, 0.2], "increment": None, "labels": ("a", "b"), "from_touch": False},
    "approaches": {"values": [0.0, 1.0], "increment": 0.5, "from_touch": False},
    "sliding": {
        "turning_points": [0.0, 5.0], "increment": 0.5, "approach": 1.0, "mean_pressure": None, "from_touch": False,
    },
    "HalfSpace": {"contact_modulus": 1.0, "poisson_ratio": 0.3},
    "FreeHalfSpace": {"contact_modulus": 1.0, "poisson_ratio": 0.3},
    "Layer": {"contact_modulus": 1.0, "poisson_ratio": 0.3, "thickness": 100.0},
    "Flat": {"length": 1000.0, "height": 1.0, "width": None},
    "Cylinder": {"length": 1000.0, "radius": 5000.0},
    "Sphere": {"length": 1000.0, "radius": 5000.0},
    "Sinusoid": {"length": 1000.0, "amplitude": 1.0, "periods": 2, "dimensions": 1},
    "SelfAffine": {
        "length": 1000.0, "hurst_exponent": 0.8, "long_cutoff": 250.0, "short_cutoff": 140.0, "rms_gradient": 0.1,
        "rms_height": None, "amplitudes": "gaussian", "dimensions": 1, "low_pass_cutoff": None, "seed": 1,
    },
    "Topography": {
        "values": line, "spacing": (10.0,), "source": "x", "filled": 0.0, "spikes": 0.0, "periodic": False,
    },
    "read_topography": {
        "path": "heights.npy", "dimensions": None, "spacing": 10.0, "unit": None, "variable": None, "delimiter": None,
        "fill": None,
    },
    "prepare_topography": {
        "topography": topography, "detrend": None, "ends": "none", "level": "none", "spikes": None,
    },
    "HardWall": {"hardness": 1.0},
    "ExponentialAttraction": LAW,
    "DugdaleAttraction": LAW | {"ramp": 0.2},
    "CohesiveZone": MIXED,
    "NormalCohesiveZone": LAW,
    "UncoupledCohesiveZone": MIXED,
    "RepulsiveZone": LAW,
    "StiffCohesiveZone": LAW | {"contact_stiffness": 1.0},
    "FrictionalRepulsiveZone": LAW | {"friction_coefficient": 0.3, "tangential_length": 1.0},
    "StiffMixedZone": MIXED | {"contact_stiffness": 1.0},
    "Aligned": {},
    "Lattice": {"lattice_constant": 10.0, "tangential_cutoff": 5.0, "normal_cutoff": 40.0, "weight": 1.0},
    "Requested": {"fold_width": 0.002, "budget": 1e5},
    "Adaptive": {"error": 1e-3, "least": 0.01, "most": 2.0, "fold_width": 0.002, "budget": 1e5},
    "Nested": {
        "full_grid_at": [0.0], "coarse_ratio": 4, "intermediate_ratio": 2, "coarse_tolerance": 1e-3,
        "intermediate_tolerance": 1e-4, "budget": 1e5,
    },
    "load_dataset": {"path": "data.nc"},
    "plot": {"data": pressed, "axes": None, "across": None, "up": None},
    "plot_characterisation": {"data": characterised, "title": "", "size": (6.9, 5.2)},
}  # fmt: skip
"""Arguments of each public function and class that can be used, all of them named."""
MADE_HERE = {"RIGID", "Law", "Result", "Status", "InputError", "__version__"}
"""Public names that are no calls, or objects that contactsim makes and nobody else."""
USUAL = {
    "stride": 2,
    "points": 16, "wavenumber": np.array([0.0, 1.0]), "factor": 2, "increment": 0.5, "pressing": None, "value": 0.01,
    "heights": line, "surface": cylinder, "law": mixed, "length": 1000.0, "steps": cohesive.path.steps,
    "solver": NewtonKrylov(), "lower": None, "upper": body, "traits": frozenset(), "laws": (mixed,),
    "problem": pose_cohesive(cohesive, cohesive.heights(16), 1e-3),
}  # fmt: skip
"""Arguments of methods, by their names."""


def methods():
    """Public methods of every public class, each with arguments that can be used."""
    for name in sorted(set(CALLS) & {name for name in CALLS if isinstance(getattr(cs, name), type)}):
        instance = getattr(cs, name)(**CALLS[name])
        for method, function in inspect.getmembers(instance, inspect.ismethod):
            if not method.startswith("_"):
                usual = USUAL | {
                    "gap": np.ones((len(getattr(instance, "reads", "nt")), 3)),
                    "steps": cohesive.path.steps,
                }
                usual |= {"lower": np.zeros(16)} if method == "join" else {}
                yield f"{name}.{method}", function, {key: usual[key] for key in inspect.signature(function).parameters}


CASES = {name: (getattr(cs, name), arguments) for name, arguments in CALLS.items()}
CASES |= {name: (function, arguments) for name, function, arguments in methods()}


@pytest.fixture
def place(tmp_path, monkeypatch):
    """A folder with the files that are read, memory for small grids only, and figures that no screen shows."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("contactsim.grid.free_memory", lambda: 2.0**30)
    np.save("heights.npy", line)
    cs.simulate(scene, points=16).to_netcdf("data.nc")
    usual = resource.getrlimit(resource.RLIMIT_AS)
    with open("/proc/self/statm") as file:
        taken = int(file.read().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (taken + MEMORY, usual[1]))
    yield
    resource.setrlimit(resource.RLIMIT_AS, usual)


def outcome(function, arguments, key, value):
    """What goes wrong with a call in which one argument is odd or missing; nothing if it works or is refused well."""
    given = {name: each for name, each in (arguments | {key: value}).items() if each is not MISSING}
    try:
        with warnings.catch_warnings(), mpl.rc_context({"backend": "agg"}):
            warnings.simplefilter("error")
            function(**given)
    except cs.InputError as error:
        text = str(error)
        return "" if "\n" not in text and (key in text or error.key in text) else f"says {text}"
    except Exception as error:
        return f"{type(error).__name__}: {error}"
    return ""


def failures(name):
    """Odd arguments, one at a time, that a call neither uses nor refuses in one line; and the number that was tried."""
    function, arguments = CASES[name]
    tried = [(key, value) for key in arguments for value in [*ODD, MISSING]] + [("no_such_option", 1)]
    results = [(key, value, outcome(function, arguments, key, value)) for key, value in tried]
    import matplotlib.pyplot as plt

    plt.close("all")
    return [f"{name}({key}={str(value)[:30]!r}) {text}" for key, value, text in results if text], len(tried)


def test_every_public_name_is_tried():
    assert set(CALLS) | MADE_HERE == set(cs.__all__)


@pytest.mark.parametrize("name", CASES)
def test_an_odd_argument_is_used_or_refused_in_one_line(name, place):
    assert failures(name)[0] == []


def test_messages_say_what_is_wrong_and_what_to_type():
    for call, message in (
        (
            lambda: cs.simulate(cylinder),
            r"^scene: simulate needs a Scene: Scene\(lower, upper, effects, path\); got Cyl",
        ),
        (lambda: cs.press(line), r"^contact_modulus: press needs a positive number, .*; got nothing$"),
        (lambda: cs.simulate(scene, points="64"), r"^points: simulate needs a whole number, 1 or more; got '64'$"),
        (lambda: cs.simulate(scene, acuracy=0.1), r"^acuracy: got 0.1; allowed: no such option, .* mean accuracy\?$"),
        (lambda: cs.Layer(1.0, 0.3, -5), r"^thickness: Layer needs a positive number, .*, in nm; got -5$"),
        (
            lambda: cs.Scene(body, cylinder, cs.HardWall, path),
            r"^effects: Scene needs an Effect: HardWall\(\), or a list",
        ),
        (
            lambda: cs.Cylinder(1.0, 2.0, 3.0),
            r"^arguments: Cylinder needs at most 2 without a name: length, radius; got 3",
        ),
    ):
        with pytest.raises(cs.InputError, match=message):
            call()


def test_a_grid_that_memory_cannot_hold_is_refused_before_it_is_made(monkeypatch):
    monkeypatch.setattr("contactsim.grid.free_memory", lambda: 2.0**30)
    rough = cs.SelfAffine(length=1e4, hurst_exponent=0.8, rms_gradient=0.1)
    for call in (
        lambda: cs.simulate(scene, points=10**9),
        lambda: cs.simulate(cs.Scene(body, cs.Sphere(1e3, 5e3), cs.HardWall(), path), points=10**4),
        lambda: rough.heights(10**9),
    ):
        with pytest.raises(
            cs.InputError, match=r"^points: got 10+; allowed: fewer: .* GiB of memory, and 1 GiB are free"
        ):
            call()


def test_measured_heights_in_another_unit_than_their_spacing_are_refused():
    steep, punch = (cs.Topography(1e6 * heights, (10.0,)) for heights in (line, line == line.max()))
    loads = {"contact_modulus": 1.0, "mean_pressure": 0.01}
    for call in (
        lambda: cs.press(steep, **loads),
        lambda: cs.characterise(steep, contact_modulus=1.0, mean_pressures=[0.01]),
        lambda: cs.simulate(cs.Scene(body, steep, cs.HardWall(), path)),
    ):
        with pytest.raises(cs.InputError, match=r"a Topography, .* of slopes up to 10: .* different units"):
            call()
    assert cs.press(punch, **loads).status.solved  # one wall, however steep
    assert cs.press(1e6 * line, spacing=10.0, **loads).status.solved  # arrays may be in units of their own


def test_a_result_of_press_is_drawn_as_it_is():
    axes = Figure().subplots()
    assert cs.plot(pressed, axes).lines[0].get_ydata().max() == pressed.pressure.max()
    area = cs.press(np.add.outer(line, line), spacing=10.0, contact_modulus=1.0, mean_pressure=0.01)
    axes = cs.plot(area, Figure().subplots())
    assert axes.images[0].get_array().max() == area.pressure.max()
    with pytest.raises(cs.InputError, match=r"^up: "):
        cs.plot(pressed, axes, up="gap")
