from __future__ import annotations

import dataclasses
import json
import logging

import numpy as np
import pytest
import xarray as xr

import contactsim
from contactsim import dataset
from contactsim.analysis import costs
from contactsim.contact import loading
from contactsim.errors import InputError
from contactsim.paths import pressures
from contactsim.status import Status
from contactsim.study import execute
from contactsim.study.execute import RunFiles
from contactsim.study.scenes import build_setup
from contactsim.study.study import Study
from support import rough_study, smooth

LOADS = [0.02, 0.1, 0.4]
SURFACES = {
    "self_affine": rough_study.ROUGH["surface"] | {"short_cutoff": 1.0},
    "sinusoid": {"kind": "sinusoid", "length": 50.0, "amplitude": 0.2, "periods": 2},
    "cylinder": {"kind": "cylinder", "length": 40.0, "radius": 50.0},
}
POINTS = {"self_affine": 256, "sinusoid": 100, "cylinder": 101}  # the packed contact set ends within a byte, twice


def settings_of(loads=LOADS, surface="self_affine", load="reduced_pressure", **changes):
    section = {
        "title": "Rough line",
        "surface": SURFACES[surface],
        "body": {"kind": "half_space", "contact_modulus": 2.0},
        "effects": ["hard_wall"],
        "load": {load: loads},
        "points": POINTS[surface],
        "tolerance": 1e-3,
    }
    return Study.read("rough", section | changes, "ch9.yaml", 1).runs()[0].settings


@pytest.fixture
def place(tmp_path):
    """A function that runs settings into files of that name, and finds these."""

    def run(settings=None, source="source", name="run"):
        files = RunFiles(tmp_path / f"{name}.nc", tmp_path / f"{name}.json")
        if settings is not None:
            execute.run(settings, source, files)
        return files

    return run


@pytest.fixture
def solved(monkeypatch):
    """The loads (without units) that were solved, in order, of all runs from here on."""
    pressed, solve = [], pressures.solve

    def spy(method, problem, scale):
        pressed.append(problem.load)
        return solve(method, problem, scale)

    monkeypatch.setattr(pressures, "solve", spy)
    return pressed


# --- what a file holds --------------------------------------------------------------------------------------------


def rebuilt(data):
    """Heights, and of each load the contact set, pressure and gap, from the arrays of a file by numpy alone."""
    n, length, modulus = (data[name].values[()] for name in ("points", "length", "contact_modulus"))
    half = np.zeros(int(n) // 2 + 1, complex)
    half[: data.mode.size] = data.profile_real.values + 1j * data.profile_imag.values
    heights = np.fft.irfft(half * n, int(n))
    wavenumber = 2 * np.pi * np.fft.rfftfreq(int(n), length / n)
    compliance = np.divide(2, modulus * wavenumber, out=np.zeros_like(wavenumber), where=wavenumber > 0)
    states, begin = [], 0
    for row, count in enumerate(data.contact_points.values):
        contact = np.unpackbits(data.contact_bits.values[row])[: int(n)].astype(bool)
        pressure = np.zeros(int(n))
        pressure[contact] = data.contact_pressure.values[begin : begin + count]
        begin += count
        displacement = np.fft.irfft(np.fft.rfft(pressure) * compliance, int(n))
        states.append((contact, pressure, displacement - heights - data.approach.values[row]))
    assert begin == data.contact_pressure.size
    return heights, states


@pytest.mark.parametrize("surface", SURFACES)
def test_heights_contact_pressure_and_gap_follow_from_the_file_alone(place, surface):
    settings = settings_of(surface=surface)
    data = xr.load_dataset(place(settings).data)
    heights, states = rebuilt(data)
    setup = build_setup(settings)
    scene = setup.scene
    exact = scene.heights(setup.points)
    size = np.ptp(exact)
    np.testing.assert_allclose(heights, exact, rtol=0, atol=1e-14 * size)  # rounding of two transforms
    for row, (contact, pressure, gap) in enumerate(states):
        direct = contactsim.press(
            exact,
            spacing=settings["surface"]["length"] / exact.size,
            contact_modulus=2.0,
            mean_pressure=scene.path.steps[row].value,
        )
        assert np.array_equal(contact, direct.contact)
        np.testing.assert_allclose(pressure, direct.pressure, rtol=1e-7, atol=0)  # kept in single precision: 6e-8
        # The gap is a difference of heights and displacements, the latter known to 6e-8.
        np.testing.assert_allclose(gap, direct.gap, rtol=0, atol=1e-7 * (size + np.ptp(direct.gap + exact)))
        here = data.isel(reduced_pressure=row)
        assert here.contact_points.item() == contact.sum()
        assert here.relative_contact_area.item() == contact.mean() == direct.relative_contact_area
        assert here.mean_pressure.item() == pytest.approx(pressure.mean(), rel=1e-7)
        assert here.mean_gap.item() == pytest.approx(gap.mean(), rel=1e-6)
        assert here.status.item() == Status.CONVERGED.value[0]


def test_the_file_holds_the_certificate_and_the_numbers_of_the_profile(place):
    settings = settings_of()
    data = dataset.load_dataset(place(settings).data)
    heights = build_setup(settings).scene.heights(256)
    slope = np.diff(heights, append=heights[0]) / 0.25
    assert data.rms_height.item() == pytest.approx(heights.std(), rel=1e-12)
    assert data.rms_gradient.item() == pytest.approx(np.sqrt(np.mean(slope**2)), rel=1e-12)
    assert data.approach_first_touch.item() == -heights.max()
    assert (data.approach > data.approach_first_touch).all()
    assert (data.max_contact_gap <= 1e-3).all()
    assert (data.penetration <= 1e-3).all()
    assert (data.min_pressure == 0).all()
    assert (data.load_error <= 1e-12).all()
    assert (data.transforms > 0).all()
    np.testing.assert_allclose(data.mean_pressure, np.array(LOADS) * 2.0 * 0.01, rtol=1e-12)


def test_the_profile_of_a_band_limited_surface_is_kept_up_to_its_last_mode(place):
    data = dataset.load_dataset(place(settings_of()).data)
    assert data.mode.size == 64  # 63 waves longer than the shortest, and the mean


def test_every_variable_of_a_run_is_described_and_the_run_stamped(place):
    settings = settings_of()
    data = dataset.load_dataset(place(settings, source="abc").data)
    for name, item in data.variables.items():
        assert set(item.attrs) >= {"units", "long_name"}, name
    assert data.status.attrs["flag_meanings"].startswith("converged")
    assert dataset.settings_of(data) == settings
    assert data.attrs["source_digest"] == "abc"


@pytest.mark.parametrize("load", ["mean_pressure", "contact_ratio", "reduced_pressure"])
def test_a_run_can_be_asked_for_any_kind_of_load(place, load):
    files = place(settings_of([0.01, 0.02], surface="cylinder", load=load))
    data = dataset.load_dataset(files.data)
    assert data.status.dims == (load,)
    assert data[load].values.tolist() == [0.01, 0.02]
    assert (data.relative_contact_area.values > 0).all()


def test_what_does_not_converge_is_kept_with_its_status(place):
    settings = settings_of(solver={"kind": "polonsky_keer", "batch": 1, "budget": 1})
    data = dataset.load_dataset(place(settings).data)
    assert data.status.values.tolist() == [Status.MAX_ITERATIONS.value[0]] * 3
    assert (data.iterations == 1).all()
    assert (data[["max_contact_gap", "penetration"]].to_array().max("variable") > 1e-3).all()


# --- points taken over --------------------------------------------------------------------------------------------


def test_a_list_of_loads_that_grew_solves_only_the_new_ones_and_equals_the_list_at_once(place, solved):
    place(settings_of([0.1, 0.4]), name="grown")
    assert len(solved) == 2
    grown = place(settings_of([0.02, 0.1, 0.2, 0.4, 0.8]), name="grown")
    assert len(solved) == 5
    # New ones only: 0.02, 0.2 and 0.8, whose loads are these multiples of that of 0.1.
    np.testing.assert_allclose(np.array(solved[2:]) / solved[0], [0.2, 2, 8], rtol=1e-12)
    once = place(settings_of([0.02, 0.1, 0.2, 0.4, 0.8]), name="once")
    assert len(solved) == 10
    assert grown.data.read_bytes() == once.data.read_bytes()


def test_a_list_of_loads_that_shrank_solves_nothing_and_equals_the_list_at_once(place, solved):
    place(settings_of([0.02, 0.1, 0.4]), name="shrunk")
    shrunk = place(settings_of([0.1]), name="shrunk")
    assert len(solved) == 3
    assert shrunk.data.read_bytes() == place(settings_of([0.1]), name="once").data.read_bytes()


def test_points_that_did_not_converge_are_taken_over_too(place, solved):
    solver = {"kind": "polonsky_keer", "batch": 1, "budget": 1}
    place(settings_of([0.1], solver=solver))
    grown = place(settings_of([0.02, 0.1], solver=solver))
    assert len(solved) == 2
    assert grown.data.read_bytes() == place(settings_of([0.02, 0.1], solver=solver), name="once").data.read_bytes()


def test_loads_that_a_run_alike_holds_are_not_solved_again(place, solved):
    other = place(settings_of([0.1, 0.4]), name="other")
    place(settings_of([0.02]), name="own")
    own = dataclasses.replace(place(name="own"), alike=(other, place(name="missing")))
    execute.run(settings_of([0.02, 0.1, 0.2, 0.4]), "source", own)
    np.testing.assert_allclose(np.array(solved) / solved[0], [1, 4, 0.2, 2], rtol=1e-12)
    once = place(settings_of([0.02, 0.1, 0.2, 0.4]), name="once")
    assert own.data.read_bytes() == once.data.read_bytes()
    taken, first = (json.loads(files.costs.read_text())["seconds"] for files in (own, other))
    assert first.items() <= taken.items()


def test_a_run_that_keeps_the_profile_takes_loads_of_one_that_does_not(place, solved):
    other = place(settings_of(keep=["contact", "pressure"]), name="other")
    own = dataclasses.replace(place(), alike=(other,))
    execute.run(settings_of(), "source", own)
    assert len(solved) == 3
    assert own.data.read_bytes() == place(settings_of(), name="once").data.read_bytes()


@pytest.mark.parametrize("keep", [["contact"], ["contact", "pressure", "profile", "patches"]])
def test_a_run_takes_no_loads_of_one_that_keeps_something_else_of_them(place, solved, keep):
    other = place(settings_of(keep=keep), name="other")
    execute.run(settings_of(), "source", dataclasses.replace(place(), alike=(other,)))
    assert len(solved) == 6


def test_loads_of_a_run_with_another_setting_are_not_taken_from_it(place, solved):
    other = place(settings_of(tolerance=1e-4), name="other")
    own = dataclasses.replace(place(), alike=(other,))
    execute.run(settings_of(), "source", own)
    assert len(solved) == 6
    assert own.data.read_bytes() == place(settings_of(), name="once").data.read_bytes()


def test_another_source_digest_reuses_nothing(place, solved):
    place(settings_of(), source="old")
    files = place(settings_of(), source="new")
    assert len(solved) == 6
    assert files.data.read_bytes() == place(settings_of(), source="new", name="once").data.read_bytes()


@pytest.mark.parametrize(
    "changes",
    [
        {"tolerance": 1e-4},
        {"points": 512},
        {"body": {"kind": "half_space", "contact_modulus": 1.0}},
        {"surface": "sinusoid"},
        {"solver": {"kind": "active_set", "reduction": 0.05}},
        {"load": "mean_pressure"},
    ],
    ids=["tolerance", "points", "body", "surface", "solver", "kind of load"],
)
def test_other_settings_reuse_nothing(place, solved, changes):
    place(settings_of())
    other = place(settings_of(**changes))
    assert len(solved) == 6
    assert other.data.read_bytes() == place(settings_of(**changes), name="once").data.read_bytes()


def test_each_point_is_named_by_all_that_made_it_and_not_by_the_other_loads(place):
    names = [
        set(dataset.load_dataset(place(settings_of(loads)).data).point_digest.values) for loads in ([0.1], [0.02, 0.1])
    ]
    assert names[0] < names[1]


def cut(tenths):
    return lambda content: content[: tenths * len(content) // 10]


DAMAGE = {
    "empty": lambda content: b"",
    "text": lambda content: b"no dataset at all",
    "cut near the beginning": lambda content: content[: len(content) // 50],
    **{f"cut at {tenths}/10": cut(tenths) for tenths in (3, 6, 9)},
    "last byte gone": lambda content: content[:-1],
}


@pytest.mark.parametrize("damage", DAMAGE.values(), ids=DAMAGE)
def test_a_corrupted_old_file_is_computed_anew_with_a_warning(place, solved, caplog, damage):
    files = place(settings_of())
    good = files.data.read_bytes()
    files.data.write_bytes(damage(good))
    place(settings_of())
    assert len(solved) == 6
    assert files.data.read_bytes() == good
    warned = [record for record in caplog.records if record.levelno == logging.WARNING]
    assert len(warned) == 1
    assert str(files.data) in warned[0].getMessage()


def test_a_large_old_file_cut_short_is_computed_anew(place):
    # Its arrays are compressed and lie behind the header: they are found wanting only when they are read.
    settings = settings_of([0.4], points=16384)
    settings["surface"]["short_cutoff"] = 0.02
    files = place(settings)
    good = files.data.read_bytes()
    for tenths in (2, 5, 8):
        files.data.write_bytes(cut(tenths)(good))
        place(settings)
        assert files.data.read_bytes() == good


def test_a_dataset_of_another_kind_under_the_name_is_computed_anew(place, solved):
    files = place()
    dataset.write(xr.Dataset({"length": 1.0}), files.data)
    place(settings_of())
    assert len(solved) == 3
    assert dataset.load_dataset(files.data).sizes["reduced_pressure"] == 3


# --- costs --------------------------------------------------------------------------------------------------------


def seconds_of(files):
    return json.loads(files.costs.read_text())["seconds"]


def test_costs_keep_the_seconds_of_points_taken_over(place):
    before = seconds_of(place(settings_of([0.1, 0.4])))
    files = place(settings_of([0.02, 0.1, 0.4]))
    after = seconds_of(files)
    assert before.items() < after.items()
    assert len(after) == 3
    assert all(seconds > 0 for seconds in after.values())
    assert set(after) == set(dataset.load_dataset(files.data).point_digest.values)


def test_seconds_stand_in_the_costs_and_never_in_the_dataset(place, monkeypatch):
    solve = pressures.solve
    monkeypatch.setattr(pressures, "solve", lambda *parts: dataclasses.replace(solve(*parts), seconds=123.0))
    slow = place(settings_of(), name="slow")
    monkeypatch.setattr(pressures, "solve", lambda *parts: dataclasses.replace(solve(*parts), seconds=0.5))
    fast = place(settings_of(), name="fast")
    assert slow.data.read_bytes() == fast.data.read_bytes()
    assert set(seconds_of(slow).values()) == {123.0}
    assert set(seconds_of(fast).values()) == {0.5}


def test_without_the_old_costs_points_are_taken_over_with_unknown_seconds(place, solved):
    place(settings_of([0.1])).costs.unlink()
    after = list(seconds_of(place(settings_of([0.02, 0.1]))).values())
    assert len(solved) == 2
    assert np.isfinite(after).tolist() == [True, False]


@pytest.mark.parametrize("content", ["", "{}", "[]", "null", '{"seconds": [1.0]}', '{"seconds"'])
def test_damaged_costs_do_not_stop_a_run(place, content):
    files = place(settings_of([0.1]))
    good = files.data.read_bytes()
    files.costs.write_text(content)
    place(settings_of([0.1]))
    assert files.data.read_bytes() == good
    assert list(seconds_of(files)) == [dataset.load_dataset(files.data).point_digest.item()]


def test_the_table_of_costs_has_a_row_for_each_solved_load(place):
    files = place(settings_of())
    run = {"path": str(files.data), "costs": str(files.costs), "coordinates": {"hurst_exponent": 0.8}}
    table = costs.table([run | {"member": 0, "measures_error": False}])
    data = dataset.load_dataset(files.data)
    assert table.reduced_pressure.tolist() == LOADS
    assert table.transforms.tolist() == data.transforms.values.tolist()
    assert table.seconds.tolist() == [seconds_of(files)[name] for name in data.point_digest.values]
    assert (table.status == 0).all()
    assert (table.points == 256).all()
    assert set(table.run) == {str(files.data)}
    assert set(table.hurst_exponent) == {0.8}


# --- failures and the log -----------------------------------------------------------------------------------------


def test_a_failure_on_the_way_leaves_the_old_files_and_no_others(place, monkeypatch):
    files = place(settings_of([0.1]))
    before = files.data.read_bytes(), files.costs.read_bytes()

    def fail(*parts):
        raise MemoryError("no room")

    monkeypatch.setattr(pressures, "solve", fail)
    with pytest.raises(MemoryError):
        place(settings_of([0.02, 0.1]))
    assert (files.data.read_bytes(), files.costs.read_bytes()) == before
    assert sorted(files.data.parent.iterdir()) == sorted([files.data, files.costs])


def step_lines(caplog):
    return [record.getMessage() for record in caplog.records if record.levelno == logging.INFO]


def test_the_log_has_a_line_for_each_step_with_load_residual_transforms_and_seconds(place, caplog):
    caplog.set_level(logging.INFO, "contactsim.paths.pressures")
    data = dataset.load_dataset(place(settings_of()).data)
    lines = step_lines(caplog)
    assert len(lines) == 3
    for number, (line, load, transforms) in enumerate(zip(lines, LOADS, data.transforms.values, strict=True), 1):
        assert line.startswith(f"step {number}/3 reduced_pressure={load:g} residual ")
        assert f"transforms {transforms:.0f}" in line
        assert " s left: converged" in line


def test_the_log_says_which_steps_are_taken_over(place, caplog):
    place(settings_of([0.1]))
    caplog.set_level(logging.INFO, "contactsim.paths.pressures")
    place(settings_of())
    first, second, third = step_lines(caplog)
    assert second == "step 2/3 reduced_pressure=0.1 taken over"
    assert "taken over" not in first + third


def test_the_time_left_is_that_of_steps_still_to_be_solved(place, caplog, monkeypatch):
    solve = pressures.solve
    monkeypatch.setattr(pressures, "solve", lambda *parts: dataclasses.replace(solve(*parts), seconds=100.0))
    place(settings_of([0.02, 0.4]))
    caplog.set_level(logging.INFO, "contactsim.paths.pressures")
    place(settings_of([0.02, 0.1, 0.2, 0.4]))
    lines = step_lines(caplog)
    # Two of four are known: after the first of the other two, one of 100 s is left; after that, none.
    assert "100.00 s, 100 s left" in lines[1]
    assert "100.00 s, 0 s left" in lines[2]


# --- options ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("options", "refused"),
    [
        (
            {"snapshots": [0.1]},
            r"snapshots: got \(0\.1,\); allowed: none with a hard wall, only points, tolerance, .* keep$",
        ),
        ({"keep": ["contacts"]}, "keep: got 'contacts'; allowed: some of contact, pressure, profile, fields"),
    ],
)
def test_what_a_hard_wall_has_no_use_for_is_refused(options, refused):
    with pytest.raises(InputError, match=refused):
        contactsim.simulate(build_setup(settings_of()).scene, points=256, **options)


def test_what_a_smooth_law_has_no_use_for_is_refused():
    scene = smooth.scene_of(smooth.LAWS["uncoupled"], loading.approaches([-9.0]))
    with pytest.raises(
        InputError,
        match=r"keep: got \('contact',\); allowed: none with smooth laws, only points, .* keep_fields, until$",
    ):
        contactsim.simulate(scene, points=64, keep=["contact"])
