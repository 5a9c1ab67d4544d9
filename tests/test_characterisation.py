"""What a contact transmits at several loads, with the change on halving the grid as its error."""

from __future__ import annotations

import re

import numpy as np
import pytest
import xarray as xr
from matplotlib import get_data_path

import contactsim as cs
from contactsim.cli import main
from contactsim.error_control.estimates import tell_error
from contactsim.figures.characterisation import plot_characterisation
from contactsim.observables.contact import relative_contact_area_subgrid
from contactsim.status import FLAGS, Status
from support.cases import refused, rough

LOADS = [0.01, 0.1, 0.3]
ELEVATION = f"{get_data_path()}/sample_data/jacksboro_fault_dem.npz"
"""An elevation model that comes with matplotlib."""


def surface(points=128):
    """Return a smooth rough surface."""
    length = float(points)
    heights = cs.SelfAffine(length, 0.8, length / 4, 16.0, 1.0, dimensions=2, seed=1).heights(points)
    return cs.Topography(heights, 1.0)


@pytest.mark.parametrize("periodic", [True, False])
def test_numbers_are_those_of_single_loads_and_errors_told_by_every_second_and_fourth_point(periodic):
    whole = surface()
    data = cs.characterise(whole, contact_modulus=1.0, mean_pressures=LOADS, periodic=periodic)
    parts = [cs.Topography(whole.values[::stride, ::stride], stride) for stride in (4, 2)]
    results = [
        [
            cs.press(heights, contact_modulus=1.0, mean_pressure=load, tolerance=1e-4, periodic=periodic)
            for load in LOADS
        ]
        for heights in (*parts, whole)
    ]
    for name, read in {
        "approach": lambda result: result.approach,
        "mean_gap": lambda result: result.gap.mean(),
        "max_pressure": lambda result: result.pressure.max(),
        "contact_stiffness": cs.contact_stiffness,
        "relative_contact_area_subgrid": lambda result: relative_contact_area_subgrid(
            result.pressure, result.gap, periodic
        ),
    }.items():
        values = [np.array(list(map(read, row))) for row in results]
        assert data[name].values == pytest.approx(values[-1], rel=1e-12)
        assert data[f"{name}_grid_error"].values == pytest.approx(tell_error(values, (2.0, 2.0)), rel=1e-9)
    for load, result in zip(LOADS, results[-1], strict=True):
        assert data.sel(mean_pressure=load).patches == cs.find_patches(result.contact, periodic).count
    assert data.contact_stiffness.attrs["units"] == "GPa/nm"
    assert data.rms_height == pytest.approx(whole.values.std())


def test_its_errors_hold_on_finer_grids():
    """Of a surface that is smooth at the spacing, numbers on four times the points are within the errors."""
    waves = cs.SelfAffine(128.0, 0.8, 32.0, 16.0, 1.0, dimensions=2, seed=1)
    one, two = (
        cs.characterise(
            cs.Topography(waves.heights(points), 128.0 / points),
            contact_modulus=1.0,
            mean_pressures=[0.1],
            periodic=True,
        )
        for points in (128, 512)
    )
    for name in ("relative_contact_area_subgrid", "contact_stiffness", "mean_gap", "max_pressure"):
        assert abs(one[name] - two[name]) <= one[f"{name}_grid_error"], name


def test_no_error_is_told_by_a_part_of_the_points_that_was_not_solved(monkeypatch):
    def fail(scene, **options):
        data = cs.simulate(scene, **options)
        if data.points.item() == 64:
            data = data.assign(status=data.status * 0 + Status.MAX_ITERATIONS.value[0])
        return data

    monkeypatch.setattr("contactsim.characterisation.simulate", fail)
    data = cs.characterise(surface(), contact_modulus=1.0, mean_pressures=LOADS, periodic=True)
    assert np.isinf(data.approach_grid_error).all()
    assert np.isfinite(data.rms_height_grid_error)


def test_a_share_of_the_contact_has_an_error_of_a_point_though_all_grids_agree():
    data = cs.characterise(surface(), contact_modulus=1.0, mean_pressures=[0.1], hardness=50.0, periodic=True)
    assert data.yielding_share == 0
    assert data.yielding_share_grid_error >= 1 / (data.relative_contact_area_subgrid * 128**2)


def test_what_would_yield_and_slopes_that_are_too_large_are_told():
    whole = surface()
    data = cs.characterise(whole, contact_modulus=1.0, mean_pressures=[0.1], hardness=0.5, periodic=True)
    pressure = cs.press(whole, contact_modulus=1.0, mean_pressure=0.1, tolerance=1e-4, periodic=True).pressure
    assert data.yielding_share[0] == pytest.approx((pressure > 0.5).sum() / (pressure > 0).sum(), abs=1e-3)
    assert data.validity_flags.item() == FLAGS["rms_gradient"] + FLAGS["yielding_share"]
    gentle = cs.Topography(whole.values / 10, 1.0)
    assert not cs.characterise(gentle, contact_modulus=1.0, mean_pressures=[0.1]).validity_flags.any()
    with refused("hardness", "a positive"):
        cs.characterise(whole, contact_modulus=1.0, mean_pressures=[0.1], hardness=0.0)


def test_a_contact_at_the_ends_has_no_edge_there():
    pressure = np.array([1.0, 1.0, 0.5, 0.0, 0.0, 0.0, 0.5, 1.0])
    gap = np.array([0.0, 0.0, 0.0, 0.1, 0.3, 0.1, 0.0, 0.0])
    assert relative_contact_area_subgrid(pressure, gap, periodic=False) == relative_contact_area_subgrid(pressure, gap)
    cut_pressure, cut_gap = pressure[:5], gap[:5]
    one_side = (relative_contact_area_subgrid(pressure, gap) * 8 - 5) / 2 + 3
    assert relative_contact_area_subgrid(cut_pressure, cut_gap, periodic=False) * 5 == pytest.approx(one_side)
    near = np.array([1.0, 1.0, 0.5, 0.0])  # no second point beyond the edge
    assert relative_contact_area_subgrid(near, np.array([0, 0, 0, 0.1]), periodic=False) * 4 == pytest.approx(2.81)


def test_what_cannot_be_characterised_is_refused():
    for topography, pressures, key in (
        (np.zeros((9, 9)), LOADS, "topography"),
        (cs.Topography(np.zeros((9, 7)), 1.0), LOADS, "topography"),
        (surface(), [], "mean_pressures"),
        (surface(), [0.0], "mean_pressures"),
        (surface(), "0.1", "mean_pressures"),
        (surface(), [[0.1]], "mean_pressures"),
    ):
        with refused(key, ""):
            cs.characterise(topography, contact_modulus=1.0, mean_pressures=pressures)


def test_from_a_file_to_a_figure_in_one_command(tmp_path, capsys):
    figure, output = tmp_path / "contact.png", tmp_path / "contact.nc"
    loads = ["--contact-modulus", "70", "--mean-pressure", "0.1", "1"]
    stated = ["--variable", "elevation", "--unit", "m", "--spacing", "3e10"]
    wanted = ["--hardness", "30", "--figure", str(figure), "--output", str(output)]
    main(["press", ELEVATION, *loads, *stated, *wanted])
    text = capsys.readouterr().out
    assert "Beyond what the model holds for: rms slope up to 0.82 (limit 0.45) in all" in text
    assert "of the contact" in text
    assert "344 × 403 points" in text
    assert text.count("converged") == 2
    assert figure.stat().st_size > 10_000
    with xr.open_dataset(output) as data:
        assert data.mean_pressure.values.tolist() == [0.1, 1.0]
        assert data.attrs["source_digest"]
        assert float(data.contact_stiffness[0]) > 0
        assert f"{float(data.mean_gap[0]):.3e}".split("e")[0] in text.replace("(", "")


def test_the_command_tells_what_it_repaired_and_what_it_cannot_read(tmp_path, capsys):
    heights = np.random.default_rng(0).normal(size=(20, 20))
    heights[3, 4], heights[5, 6] = np.nan, 100.0
    np.save(tmp_path / "scan.npy", heights)
    loads = ["--contact-modulus", "1", "--mean-pressure", "0.1", "--spacing", "1", "2"]
    main(["press", str(tmp_path / "scan.npy"), *loads, "--fill", "linear", "--spikes", "8", "--ends", "mirror"])
    text = capsys.readouterr().out
    assert "38 × 38 points on 38 × 76 nm" in text
    assert "0.25% of the points filled, 0.25% of the points replaced as spikes" in text
    for options, message in (
        ([], "fill"),
        (["--fill", "linear", "--figure", "contact.jpg"], "--figure: got 'contact.jpg'"),
        (["--fill", "linear", "--level", "plane"], "level: got 'plane'"),
    ):
        with pytest.raises(SystemExit, match=message):
            main(["press", str(tmp_path / "scan.npy"), *loads, *options])


def test_the_command_says_how_it_presses_and_doubts_what_is_probably_not_meant(tmp_path, capsys):
    np.save(tmp_path / "scan.npy", np.random.default_rng(0).normal(size=(20, 20)))
    press = ["press", str(tmp_path / "scan.npy"), "--contact-modulus", "1", "--spacing", "10", "--mean-pressure"]
    main([*press, "1e-3"])
    text = capsys.readouterr().out
    assert "E* 1 GPa, plane subtracted, pressed alone on a half-space, not repeated" in text
    assert "E*: pressures are in GPa" not in text
    main([*press, "1e-3", "100", "--periodic", "--spikes", "2", "--detrend", "none"])
    text = capsys.readouterr().out
    assert "E* 1 GPa, pressed on a half-space, repeated without end" in text
    assert "contact everywhere at 100 GPa and more, which is 100 E*: pressures are in GPa" in text
    assert "% of the points are no spikes: a larger threshold may be meant" in text


def test_the_command_doubts_contacts_of_few_points_and_pressures_beyond_the_modulus(tmp_path, capsys):
    np.save(tmp_path / "scan.npy", np.random.default_rng(0).normal(size=(20, 20)))
    press = ["press", str(tmp_path / "scan.npy"), "--contact-modulus", "1", "--spacing", "1", "2", "--mean-pressure"]
    main([*press, "1e-9"])
    text = capsys.readouterr().out
    assert "fewer than 10 points in contact up to 1e-09 GPa" in text
    assert "20 × 20 points on 20 × 40 nm, 1 × 2 nm apart" in text
    assert "strains are not small" not in text
    main([*press, "0.5"])
    text = capsys.readouterr().out
    assert re.search(r"a largest pressure of [\d.]+ E\* at 0.5 GPa: strains are not small", text)
    assert "fewer than" not in text
    np.save(tmp_path / "flat.npy", 1e-3 * np.random.default_rng(1).normal(size=(20, 20)))
    pair = ["--other", str(tmp_path / "flat.npy"), "--offset", "4", "4"]
    main([*press, "100", "10", "0.02", *pair, "--periodic"])
    assert "contact everywhere at 10 GPa and more" in capsys.readouterr().out
    main([*press, "0.02", *pair])
    assert "fewer than 10 points in contact up to 0.02 GPa" in capsys.readouterr().out


def test_the_command_refuses_by_the_names_of_its_options_and_before_it_solves(tmp_path):
    np.save(tmp_path / "scan.npy", np.full((20, 20), np.nan))
    np.save(tmp_path / "small.npy", np.eye(4))
    np.save(tmp_path / "large.npy", np.eye(16))
    (tmp_path / "file").write_text("")
    (tmp_path / "folder.nc").mkdir()
    press = ["press", str(tmp_path / "scan.npy"), "--contact-modulus", "1", "--mean-pressure"]
    small = ["press", str(tmp_path / "small.npy"), *press[2:]]
    large = ["press", str(tmp_path / "large.npy"), *press[2:-1]]
    for arguments, message in (
        (press, r"; or --fill as one of"),
        (small, "small.npy: got shape"),
        ([*large, "--figure", str(tmp_path / "file/a.png"), press[-1]], "--figure: got .*: a file in a folder"),
        ([*large, "--output", str(tmp_path / "folder.nc"), press[-1]], "--output: got .*this is a folder"),
    ):
        with pytest.raises(SystemExit, match=message):
            main([*arguments, "0.1", "--spacing", "1"])
    with pytest.raises(SystemExit, match="--mean-pressure: got"):
        main(["press", str(tmp_path / "small.npy"), *press[2:], "0.1", "0.1", "--spacing", "1"])


def test_two_scans_may_have_units_of_their_own(tmp_path, capsys):
    heights = np.random.default_rng(0).normal(size=32)
    np.savetxt(tmp_path / "a.csv", np.c_[np.arange(32), heights], delimiter=",", header="x [nm], z [nm]", comments="")
    np.savetxt(tmp_path / "b.csv", np.c_[np.arange(32), heights] / 1e3, delimiter=",")
    press = ["press", str(tmp_path / "a.csv"), "--other", str(tmp_path / "b.csv"), "--contact-modulus", "1"]
    main([*press, "--mean-pressure", "0.1", "--other-unit", "um"])
    assert "32 points on 32 nm; 32 points on 32 nm" in capsys.readouterr().out
    swapped = ["press", press[3], "--other", press[1], *press[4:], "--unit", "um", "--other-unit", "mm"]
    with pytest.raises(SystemExit, match="--other-unit: got 'mm'"):
        main([*swapped, "--mean-pressure", "0.1"])
    with pytest.raises(SystemExit, match="--unit: got 'um'"):
        main([*press, "--mean-pressure", "0.1", "--unit", "um"])
    with pytest.raises(SystemExit, match="--other-unit: got 'um'; allowed: none without --other"):
        main([*press[:2], *press[4:], "--mean-pressure", "0.1", "--other-unit", "um"])


def test_a_figure_stands_in_a_folder_of_its_own(tmp_path, capsys):
    np.save(tmp_path / "scan.npy", np.random.default_rng(0).normal(size=(16, 16)))
    target = tmp_path / "new/folder/contact.png"
    loads = ["--contact-modulus", "1", "--mean-pressure", "0.1", "--spacing", "1"]
    main(["press", str(tmp_path / "scan.npy"), *loads, "--figure", str(target)])
    assert target.stat().st_size > 1000


@pytest.mark.parametrize("tolerance", [0.0, 0.2, 1e6, "tight"])
def test_a_tolerance_that_means_little_is_refused(tolerance):
    with refused("tolerance", "at most 0.1"):
        cs.press(rough(64), contact_modulus=1.0, mean_pressure=0.1, spacing=1.0, tolerance=tolerance)
    with refused("tolerance", "at most 0.1"):
        cs.characterise(surface(), contact_modulus=1.0, mean_pressures=LOADS, tolerance=tolerance)


def test_what_is_no_contact_no_dataset_and_no_body_is_refused():
    result = cs.press(rough(64), contact_modulus=1.0, mean_pressure=0.1, spacing=1.0)
    with refused("contact", "`contact` of a result"):
        cs.find_patches(result)
    with refused("data", "characterise"):
        cs.plot_characterisation(result)
    with refused("lower", "an Elasticity: HalfSpace(contact_modulus)"):
        cs.Scene(surface(), cs.HalfSpace(1.0), cs.HardWall(), cs.pressures([0.1]))
    for upper in (cs.HalfSpace(1.0), cs.Cylinder):
        with refused("upper", "a Surface: Cylinder(length, radius)"):
            cs.Scene(cs.HalfSpace(1.0), upper, cs.HardWall(), cs.pressures([0.1]))
    with refused("elasticity", "an Elasticity"):
        cs.Body(surface(), surface())
    with refused("surface", "a Surface"):
        cs.Body(cs.HalfSpace(1.0))
    with refused("stiffness", "0 or more"):
        cs.conductance(-1.0, 1.0, (1.0, 1.0))


def test_the_figure_has_four_panels_with_bars():
    data = cs.characterise(surface(), contact_modulus=1.0, mean_pressures=LOADS, periodic=True)
    panels = plot_characterisation(data).axes
    assert len(panels) == 4
    assert panels[0].figure.get_suptitle() == "$E^*$ = 1 GPa"
    assert plot_characterisation(data, title="a$b.npz").get_suptitle() == r"a\$b.npz, $E^*$ = 1 GPa"
    assert all(axes.containers[0].has_yerr for axes in panels)
    assert panels[0].get_legend() is not None
    line = cs.characterise(cs.Topography(surface().values[0], 1.0), contact_modulus=1.0, mean_pressures=LOADS)
    assert plot_characterisation(line).axes[0].get_legend() is None  # Persson's theory is of surfaces


def test_flags_are_those_of_each_load_and_tell_what_would_yield():
    numbers = cs.characterise(
        cs.Topography(rough(256), 1.0), contact_modulus=1.0, mean_pressures=[1e-3, 0.3], hardness=0.8, periodic=True
    )
    yields = numbers.yielding_share.values > 0
    assert ((numbers.validity_flags.values & FLAGS["yielding_share"]) > 0).tolist() == yields.tolist()
    assert yields[-1]


def test_the_gradient_of_periodic_heights_has_the_step_between_their_ends():
    slope = cs.Topography(np.arange(32.0), 1.0)
    alone, periodic = (
        cs.characterise(slope, contact_modulus=1.0, mean_pressures=[1e-3], periodic=repeats).rms_gradient.item()
        for repeats in (False, True)
    )
    assert alone == 1
    assert periodic == pytest.approx(np.sqrt((31 + 31**2) / 32))


@pytest.mark.parametrize("periodic", [True, False])
def test_two_scans_are_pressed_as_the_sum_of_their_heights(periodic):
    first, second = surface(), cs.Topography(np.roll(surface().values, 5, 0), surface().spacing)
    moved = np.roll(second.values, (3, -2), (0, 1))
    both = cs.Topography(first.values + moved, first.spacing)
    if not periodic:
        both = cs.Topography(first.values[3:, :-2] + second.values[:-3, 2:], first.spacing)
    options = {"contact_modulus": 1.0, "mean_pressures": LOADS, "periodic": periodic}
    pair, single = cs.characterise(first, second, offset=(3, -2), **options), cs.characterise(both, **options)
    xr.testing.assert_equal(pair, single)


def test_the_conductance_of_each_load_follows_from_its_stiffness_and_has_its_relative_error():
    data = cs.characterise(
        surface(), contact_modulus=2.0, mean_pressures=LOADS, conductivities=(400.0, np.inf), periodic=True
    )
    assert data.contact_conductance.values == pytest.approx(2 * data.contact_stiffness.values * 400 / 2.0)
    error = data.contact_conductance_grid_error / data.contact_conductance
    assert error.values == pytest.approx((data.contact_stiffness_grid_error / data.contact_stiffness).values)
    assert data.contact_conductance.units == "W/(m K nm)"


def test_the_second_scan_and_its_place_are_checked():
    def press(*others, **options):
        cs.characterise(surface(), *others, contact_modulus=1.0, mean_pressures=[0.1], **options)

    with refused("other", "a Topography"):
        press(rough(64))
    with refused("offset", "none without"):
        press(offset=(1, 1))
    with refused("other", "that of heights"):
        press(cs.Topography(rough(64), 3.0), periodic=True)
    with refused("conductivities", "a pair of positive numbers"):
        press(conductivities=(1.0, -1.0))
    with refused("spacing", "periodic"):
        press(spacing=1.0)


def test_the_command_presses_two_scans_that_repeat_and_tells_their_conductance(tmp_path, capsys):
    heights = surface().values
    np.save(tmp_path / "one.npy", heights)
    np.save(tmp_path / "two.npy", heights[:, ::-1])  # seen from outside its body
    loads = ["--contact-modulus", "1", "--mean-pressure", "0.01", "--spacing", "1", "--detrend", "none"]
    both = ["--other", str(tmp_path / "two.npy"), "--offset", "1", "2", "--conductivities", "400", "60", "--periodic"]
    output = tmp_path / "contact.nc"
    main(["press", str(tmp_path / "one.npy"), *loads, *both, "--output", str(output)])
    text = capsys.readouterr().out
    for more, message in (
        (["--other", str(tmp_path / "small.npy")], r"--other .*small\.npy: got shape \(32, 32\)"),
        ([*both[:2], "--offset", "125", "0"], r"--offset: got \(125, 0\); allowed: one that leaves 16"),
    ):
        np.save(tmp_path / "small.npy", heights[:32, :32])
        periodic = ["--periodic"] if "small" in more[1] else []
        with pytest.raises(SystemExit, match=message):
            main(["press", str(tmp_path / "one.npy"), *loads, *more, *periodic])
    assert "they face each other on 128 × 128 nm, over which pressures are means: rms height" in text
    assert "conductance" in text and "W/(m K nm)" in text
    sum_of_both = cs.Topography(heights + np.roll(heights, (1, 2), (0, 1)), 1.0)
    expected = cs.characterise(sum_of_both, contact_modulus=1.0, mean_pressures=[0.01], periodic=True)
    with xr.open_dataset(output) as data:
        assert data.contact_stiffness.values == pytest.approx(expected.contact_stiffness.values)


def test_the_command_presses_a_layer(tmp_path, capsys):
    np.save(tmp_path / "one.npy", surface().values)
    loads = ["--contact-modulus", "1", "--mean-pressure", "0.01", "--spacing", "1"]
    layer = ["--thickness", "20", "--poisson-ratio", "0.3"]
    main(["press", str(tmp_path / "one.npy"), *loads, *layer, "--ends", "mirror"])
    assert "converged" in capsys.readouterr().out
    with pytest.raises(SystemExit, match="--poisson-ratio"):
        main(["press", str(tmp_path / "one.npy"), *loads, *layer[:2], "--ends", "mirror"])


def test_complete_contact_is_told_and_drawn(tmp_path, capsys):
    np.save(tmp_path / "one.npy", surface().values)
    loads = ["--contact-modulus", "1", "--mean-pressure", "1e3", "--spacing", "1", "--periodic"]
    main(["press", str(tmp_path / "one.npy"), *loads, "--figure", str(tmp_path / "contact.png")])
    assert "inf" in capsys.readouterr().out
    with pytest.raises(SystemExit, match=r"--output: got 'contact\.txt'"):
        main(["press", str(tmp_path / "one.npy"), *loads, "--output", "contact.txt"])
