"""Each example runs, draws one figure, and its numbers are those of exact or known answers."""

from __future__ import annotations

import runpy

import matplotlib as mpl
import numpy as np
import pytest

from contactsim.reference import adhesion, adhesive_sphere, hard_wall, springs
from support.places import ROOT

EXAMPLES = {file.stem: file for file in sorted((ROOT / "examples").glob("plot_*.py"))}


@pytest.fixture
def run(caplog):
    """Run an example, check its figure, and return its variables."""
    mpl.use("Agg")
    import matplotlib.pyplot as plt

    def run_once(name: str, *, warns: str = "") -> dict:
        plt.close("all")
        try:
            names = runpy.run_path(str(EXAMPLES[name]))
            (number,) = plt.get_fignums()
            figure = plt.figure(number)
            figure.canvas.draw()
            for axes in figure.axes:
                assert axes.get_xlabel() or axes.get_ylabel()
        finally:
            plt.close("all")
        assert all(warns and warns in record.message for record in caplog.records)  # no state is beyond the model
        return names

    return run_once


def test_every_example_is_checked():
    assert len(EXAMPLES) == 12
    checked = {name.removeprefix("test_") for name in globals() if name.startswith("test_plot_")}
    assert checked == set(EXAMPLES)


@pytest.mark.parametrize("name", EXAMPLES)
def test_every_example_has_a_title_and_cells(name):
    text = EXAMPLES[name].read_text(encoding="utf-8")
    _, title, line, blank, *_ = text.splitlines()
    assert len(title) == len(line) and set(line) == {"="} and not blank
    assert text.count("\n# %%\n") >= 2
    assert "savefig" not in text and "plt.show" not in text


def test_plot_hertz(run):
    names = run("plot_hertz")
    assert names["cylinder_errors"][-1] < 5e-5
    assert names["sphere_errors"][-1] < 2e-5
    orders = list(names["orders"].values())
    assert orders == pytest.approx([1.0, 1.6, 2.0], abs=0.3)


def test_plot_area_and_pressure(run):
    names = run("plot_area_and_pressure")
    high = names["reduced"] > 1.0
    from_theory = names["mean"].values[:, high] / names["persson_area"](names["reduced"][high]) - 1
    assert np.abs(from_theory).max() < 0.01
    assert (names["area"].values[..., -1] == 1).all()  # complete contact
    line = names["cs"].SelfAffine(8e3, 0.8, 1e3, 16.0, names["rms_gradient"], seed=0)
    needed = -hard_wall.complete_contact(line.heights(16384), 8e3, names["contact_modulus"]).min()  # exact
    complete = names["data"].mean_pressure.sel(hurst_exponent=0.8, member=0).values > needed
    assert ((names["area"].sel(hurst_exponent=0.8, member=0).values == 1) == complete).all()


def test_plot_rough_surface_maps(run):
    names = run("plot_rough_surface_maps")
    assert max(names["gap_in_contact"], names["overlap"]) < 1e-4  # nm, by numpy alone; gaps are up to 10 nm
    assert np.abs(names["gap"] - names["result"].gap).max() < 1e-9
    assert names["result"].pressure.mean() == pytest.approx(names["mean_pressure"], rel=1e-9)
    widths = np.diff(names["edges"])
    assert (names["density"] * widths).sum() == pytest.approx(names["result"].relative_contact_area, rel=1e-9)


def test_plot_accuracy_and_cost(run):
    names = run("plot_accuracy_and_cost", warns="grid spacing over the shortest wavelength")
    assert (names["true_errors"] < names["accuracies"]).all()
    assert (names["true_errors"] > names["accuracies"] / 50).all()  # no grid is far finer than need be
    assert (names["true_errors"] <= names["estimated_errors"]).all()
    assert (names["estimated_errors"] <= names["accuracies"]).all()
    assert (np.diff(names["work"]) > 0).all()


def test_plot_measured_topography(run):
    names = run("plot_measured_topography")
    stiffness = names["alone"].contact_stiffness.values
    assert stiffness[-1] == pytest.approx(names["punch_stiffness"], rel=0.004)
    assert names["repeated"].contact_stiffness.values[-1] > 1e4 * stiffness[-1]
    # the gap by a sum over point loads, where no load is near
    pressed, step = names["pressed"], names["topography"].spacing[0]
    loaded = np.argwhere(pressed.contact)
    for place in np.argwhere(~pressed.contact)[::5003]:
        distance = np.hypot(*(loaded - place).T) * step
        if distance.min() < 5 * step:
            continue
        forces = pressed.pressure[pressed.contact] * step**2
        displacement = np.sum(forces / distance) / (np.pi * names["contact_modulus"])
        gap = displacement - names["topography"].values[tuple(place)] - pressed.approach
        assert gap == pytest.approx(pressed.gap[tuple(place)], rel=2e-3)


def test_plot_two_rough_bodies(run):
    names = run("plot_two_rough_bodies")
    assert names["areas"][0] == 1.0  # the surfaces fit together
    assert names["areas"][-6:] == pytest.approx(names["single"], rel=0.06)
    assert names["independent"] == pytest.approx(names["single"], rel=0.03)
    assert (np.diff(names["areas"][:8]) < 0).all()


def test_plot_adhesive_cylinder(run):
    names = run("plot_adhesive_cylinder")
    exact = adhesion.cylinder_pull_off(0.05, 1e4, 1.0)
    assert names["pull_off"] == pytest.approx(exact, rel=0.01)
    assert names["loads"] == pytest.approx(names["jkr_load"](names["half_widths"]), abs=0.04 * exact)
    data = names["data"]
    first, last = data.fold_approach_before.values
    assert last < first < 0  # it jumps off later than it jumps on
    between = np.linspace(last, first, 400)  # the loop is open between the jumps only
    turn = int(data.approach.values.argmax())
    pulled = data.isel(step=slice(turn, None))
    load = np.interp(between, pulled.approach.values[::-1], pulled.line_load.values[::-1])
    assert names["dissipated"] == pytest.approx(-np.trapezoid(load, between), rel=0.05)


def test_plot_adhesive_sphere(run):
    names = run("plot_adhesive_sphere")
    for parameter, pull in names["dugdale"].items():
        assert pull == pytest.approx(names["exact"][parameter], rel=0.005)
        radius, force, approach = adhesive_sphere.maugis_states(
            **names["sphere"], strength=parameter / names["parameter_of_one_gpa"]
        )
        stable = np.argsort(approach[radius > 60.0])
        wanted = np.interp(names["approaches"][:10], approach[radius > 60.0][stable], force[radius > 60.0][stable])
        assert names["curves"][parameter][:10] == pytest.approx(wanted, abs=0.015 * pull)
    ratios = np.array([names["exponential"][key] / names["exact"][key] for key in names["exponential"]])
    assert ((ratios > 1) & (ratios < 1.05)).all()
    assert names["exponential"][3.0] / names["jkr"] == pytest.approx(1.0, abs=0.03)


def test_plot_own_law(run):
    names = run("plot_own_law")
    assert names["derivative_error"] < 1e-7
    for name, law in names["laws"].items():
        exact = 2 * np.pi * 1000.0 * law.energy(-names["approaches"][None])
        assert names["forces"][name] == pytest.approx(exact, abs=0.01 * abs(exact).max())
        assert -names["forces"][name].min() == pytest.approx(2 * np.pi * 0.1 * 1000.0, rel=0.002)


def test_plot_stick_slip(run):
    names = run("plot_stick_slip")
    for modulus, tractions in names["computed"].items():
        assert tractions == pytest.approx(names["exact"][modulus], abs=1e-4 * names["exact"][modulus].max())
    assert names["slips"] == dict(zip(names["moduli"], (3, 4, 0), strict=True))
    assert 140.0 < names["critical_modulus"] < 600.0
    assert springs.steepest_fall(names["lattice_constant"]) == pytest.approx(names["steepest"] / 0.2)


def test_plot_partial_slip(run):
    names = run("plot_partial_slip")
    assert names["shifts"] == pytest.approx(names["exact_shifts"], rel=1e-3)
    assert names["stick_radii"] == pytest.approx(names["exact_radii"], abs=0.5)  # nm, less than half a step
    for ratio, state in zip(names["ratios"], names["states"], strict=True):
        assert state.traction.mean() == pytest.approx(ratio * 0.3 * names["mean_pressure"], rel=1e-6)


def test_plot_stiffness_and_conductance(run):
    names = run("plot_stiffness_and_conductance")
    assert names["stiffness"] == pytest.approx(names["exact_stiffness"], rel=0.002)
    assert names["gap_error"] < 1e-5
    for numbers in names["rough"].values():  # the stiffness is minus the slope of the pressure by the mean gap
        gap, pressure = numbers.mean_gap.values, names["pressures"]
        between = np.sqrt(numbers.contact_stiffness.values[1:] * numbers.contact_stiffness.values[:-1])
        assert -np.diff(pressure) / np.diff(gap) == pytest.approx(between, rel=0.15)
    steel, aluminium = names["conductivities"]
    harmonic = 2 / (1 / steel + 1 / aluminium)
    wanted = names["numbers"].contact_stiffness.values * harmonic / names["contact_modulus"]
    assert names["conductance"] == pytest.approx(wanted, rel=1e-12)
