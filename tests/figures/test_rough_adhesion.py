"""Figures of rough adhesive contact show what the datasets hold, and histograms are kept of all members."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from matplotlib.figure import Figure

from contactsim import dataset
from contactsim.analysis.rough_paths import EQUAL_PRESSURES
from contactsim.analysis.scales import LawScales
from contactsim.figures import adhesive_lines, ch5
from contactsim.observables.adhesion import CRITERION, INTERACTING
from contactsim.observables.linearity import values_at_loads
from contactsim.status import Status

ROUGH = (
    "rough_adhesive",
    "rough_adhesive_15",
    "rough_adhesive_30",
    "rough_adhesive_hurst",
    "rough_adhesive_128",
    "rough_adhesive_64",
    "rough_adhesive_coupled",
    "rough_adhesive_unloading",
    "rough_repulsive",
    "rough_stiff",
)


@pytest.fixture(scope="module")
def studies(made):
    """All studies of rough adhesive contact of the quick tier, and those of the hard wall, by name."""
    names = (*ROUGH, "rough_wall", "rough_wall_picture")
    return {name: dataset.load_dataset(made / f"results/quick/datasets/ch5_{name}.nc") for name in names}


def panels(count: int) -> list:
    figure = Figure(figsize=(3 * count, 3))
    return [figure.add_subplot(1, count, place + 1) for place in range(count)]


@pytest.mark.parametrize("name", ROUGH)
def test_every_state_converged(studies, name):
    assert (studies[name].status == Status.CONVERGED.value[0]).all()


@pytest.mark.parametrize("name", ["rough_adhesive", "rough_adhesive_hurst", "rough_adhesive_64"])
def test_histograms_are_kept_of_all_members_and_points_of_the_first_alone(studies, name):
    data = studies[name]
    for kind in ("normal_gap_share", "normal_traction_share"):
        assert np.allclose(data[kind].sum(f"{kind.removesuffix('_share')}_bin"), 1.0)
    fields = np.isfinite(data.normal_gap.isel(x=0))
    assert fields.sel(member=0).all()
    assert not fields.sel(member=slice(1, None)).any()


def test_histograms_are_those_of_the_fields(studies):
    data = studies["rough_adhesive"].sel(work_of_separation=10.5, member=0)
    for snapshot in data.snapshot:
        one = data.sel(snapshot=snapshot)
        repulsive = one.normal_gap_share.sel(normal_gap_bin=slice(None, 0.0)).sum()
        assert float(repulsive) == pytest.approx(float((one.normal_gap < 0).mean()))


def test_areas_shrink_with_the_threshold_and_those_that_repel_are_the_least(studies):
    data = studies["rough_adhesive"]
    lengths = [data[name] for name in INTERACTING]
    assert all((tight <= wide).all() for tight, wide in itertools.pairwise(lengths))
    assert (data.contact_length <= data[CRITERION] + data.length / data.points).all()


def test_areas_are_averaged_at_equal_pressures_for_every_law_and_the_wall(studies):
    axes = panels(2)
    names = ("rough_adhesive", "rough_wall", "rough_repulsive", "rough_stiff")
    data, wall, repulsive, stiff = (studies[name] for name in names)
    shown = ch5.fig_5_3(data, wall, repulsive, stiff, axes, kappa_r=1.75)
    cases = sum(part.work_of_separation.size for part in (data, repulsive, stiff)) + 1
    assert len(shown) == 2 * cases * EQUAL_PRESSURES
    wide = shown[shown.case == "hard wall"].iloc[:EQUAL_PRESSURES]
    area = [
        values_at_loads(member.normalised_pressure.values, member.relative_contact_area.values, wide.pressure.values)
        for member in (wall.sel(member=number) for number in wall.member)
    ]
    assert np.allclose(wide.area, np.mean(area, axis=0))


def test_repulsion_alone_never_pulls_and_a_stiff_one_takes_more_load(studies):
    repulsive, stiff = studies["rough_repulsive"], studies["rough_stiff"]
    assert (repulsive.adhesive_load == 0).all() and (repulsive.mean_pressure >= 0).all()
    last = {"step": -1, "work_of_separation": 0}
    assert (stiff.mean_pressure.isel(last) > repulsive.mean_pressure.isel(last)).all()


def test_the_pictures_show_the_rigid_profile_above_both_surfaces(studies):
    for draw in (ch5.fig_5_5, ch5.cover):
        shown = draw(studies["rough_adhesive"], studies["rough_wall_picture"], panels(1)[0])
        assert (shown.wall <= shown.rigid + 1e-2).all()
        assert ((shown.surface - shown.rigid) < 1.5).all()  # the law lets surfaces overlap a little
        assert shown.rigid.min() == pytest.approx(-20.0, abs=1e-6)


def test_the_cycle_dissipates_less_on_rougher_lines_and_pulls_more_when_it_is_pulled_off(studies):
    data = studies["rough_adhesive_unloading"]
    shown = adhesive_lines.unloading(data, panels(4))
    ends = shown[shown.indentation.isna()].set_index("rms_height")
    assert (np.diff(ends.dissipated_work_mean) < 0).all()
    assert (ends.dissipated_work_mean > -ends.dissipated_work_error).all()
    assert (ends.pull_off_load_unloading_mean > 0.999 * ends.pull_off_load_loading_mean).all()
    assert (ends.dissipated_work_mean < LawScales.of(data).work_of_separation).all()


def test_contact_by_five_criteria_is_shown_for_both_ends_of_the_works(studies):
    shown = adhesive_lines.thresholds(studies["rough_adhesive"], panels(3))
    assert set(shown.criterion) == {"contact_length", *INTERACTING}
    assert sorted(shown.work_of_separation.unique()) == [0.07, 10.5]


def test_means_end_where_the_path_of_one_member_does(studies):
    data = studies["rough_adhesive"]
    status, last = data.status.copy(), data.step.size - 3
    status.loc[{"member": status.member[0], "step": status.step[last:]}] = np.nan
    assert data.member.size > 1
    shown = adhesive_lines.thresholds(data.assign(status=status), panels(3))
    means = shown[shown.criterion.eq(CRITERION) & shown.area.notna()].groupby("work_of_separation").size()
    assert (means == last).all()
