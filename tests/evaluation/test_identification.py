"""Candidates for the cell of the probe: drawn in their ranges, admitted by rules, simulated, judged and drawn."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from contactsim import dataset
from contactsim.analysis.admissible import read_candidates
from contactsim.analysis.candidate_shares import FILE, SETS
from contactsim.errors import InputError
from contactsim.evaluation.identification import settings as identification
from contactsim.evaluation.identification.admission import AdmissionNumbers, Limits, admit, has_signs_of_text
from contactsim.evaluation.identification.judgement import admission_entries, candidates_table, judge_candidate
from contactsim.evaluation.identification.sampling import CandidateRanges, draw_candidates
from contactsim.evaluation.identification.simulation import DOUBLED, simulate_candidate, with_grid_change
from contactsim.figures.diagnostics.identification import write_identification
from contactsim.status import Status
from contactsim.study.figure_plan import PICTURE_ENDINGS
from contactsim.study.plan import Plan
from support.places import ROOT

RANGES = CandidateRanges([1000.0, 20000.0], [0.25, 4.0], [1.5, 6.0])
LIMITS = Limits(0.05, 0.01, 0.1, 0.01, 3, 0.0, 3.0)
APPROACHES = [-3.0, 0.0, 2.0, 10.0]
STUDY = {
    "surface": {"kind": "cylinder", "radius": 25000.0},
    "effects": ["cohesive_zone"],
    "cohesive_zone": dict.fromkeys(("work_of_separation", "normal_length", "tangential_length", "work_ratio"), 1.0),
}


def read(tier="standard"):
    return identification.read_identification(ROOT / "config", Plan.read(ROOT / "config", tier))


def slides(load=(-5.0, -2.0, 1.0, 9.0), length=(100.0, 200.0, 300.0, 500.0), friction=50.0, start=0.01, failed=False):
    """Made-up slides with what the rules read."""
    states = np.full((1, 4, 2), start)
    status = np.full((1, 4, 2), Status.CONVERGED.value[0], np.int8)
    status[0, 0, 1] = Status.MAX_ITERATIONS.value[0] if failed else status[0, 0, 0]
    data = xr.Dataset(
        {
            "initial_load": (("member", "slide_approach"), [list(load)]),
            "initial_contact_length": (("member", "slide_approach"), [list(length)]),
            "static_friction": (("member", "slide_approach"), [[friction] * 4]),
            "line_load": (("member", "slide_approach", "step"), states),
            "status": (("member", "slide_approach", "step"), status),
        },
        {"slide_approach": APPROACHES},
    )
    return dataset.stamp(data, "made up", STUDY, "")


def rules(**changes):
    """The rules that a made-up candidate meets; changes: of its own period, `other` the load in the doubled one."""
    other = changes.pop("other", {})
    return admission_entries({"probe": slides(**changes), DOUBLED: slides(**changes | other)}, "probe", LIMITS)


def test_candidates_lie_in_their_ranges_one_in_each_part_of_each_and_follow_from_the_seed():
    drawn = draw_candidates(7, 40, RANGES)
    assert drawn == draw_candidates(7, 40, RANGES)
    assert drawn != draw_candidates(8, 40, RANGES)
    width = np.array([cell.width for cell in drawn])
    ratio = np.array([cell.thickness / cell.width for cell in drawn])
    lattice = np.array([cell.lattice_constant for cell in drawn])
    for values, (low, high) in (
        (np.log(width), np.log(RANGES.width)),
        (np.log(ratio), np.log(RANGES.thickness_ratio)),
        (lattice, RANGES.lattice_constant),
    ):
        parts = np.floor((values - low) / (high - low) * 40 + 1e-3 * np.sign(0.5 - (values - low) / (high - low)))
        assert sorted(parts.astype(int)) == list(range(40))


def test_the_named_cells_are_those_of_their_studies_and_have_their_ratio():
    own = read()
    assert [cell.name for cell in own.candidates[:2]] == ["default", "narrow"]
    assert own.candidates[0].thickness / own.candidates[0].width == 0.5
    assert len(own.candidates) == 62
    study = own.job("c05", "standard").study("probe_weak")
    surface = study.settings["surface"]
    assert surface["radius"] / surface["length"] == pytest.approx(2.5)
    assert study.settings["cohesive_zone"]["work_of_separation"] == 1.0
    twice = own.job("c05", "standard").study("probe", periods=2).settings["surface"]
    assert twice == surface | {"length": 2 * surface["length"]}


def test_claims_on_the_three_interfaces_are_judged_and_no_others():
    judged = read().claims
    assert {"tensile", "threshold", "lower_friction_more_complete", "weaker_without_contact"} <= set(judged)
    assert not {"converged_increments", "apart_from_replicas", "sawtooth", "load_at_start"} & set(judged)


def test_a_candidate_that_meets_all_rules_is_sound_and_isolated():
    met = rules()
    assert (met["sound"], met["isolated"], met["signs"], met["unsolved"]) == (True, True, True, 0)
    strength = np.sqrt(2 / np.e)
    assert met["friction"] == pytest.approx(50 / (500 * strength))
    assert met["slope"] == pytest.approx(0.01)


@pytest.mark.parametrize(
    ("changes", "rule"),
    [
        ({"friction": 10.0}, "sound"),
        ({"friction": np.nan}, "sound"),
        ({"length": (100.0, 200.0, 300.0, 6000.0), "friction": 1e4}, "sound"),
        ({"length": (100.0, 200.0, 300.0, np.nan)}, "sound"),
        ({"start": 0.2}, "sound"),
        ({"other": {"load": (-5.0, -2.0, 1.2, 9.0)}}, "isolated"),
        ({"other": {"length": (107.0, 200.0, 300.0, 500.0)}}, "isolated"),
        ({"other": {"load": (-5.0, np.nan, 1.0, 9.0)}}, "isolated"),
        ({"load": (-5.0, 0.1, 1.0, 9.0)}, "signs"),
        ({"load": (-5.0, -2.0, 1.0, -0.1)}, "signs"),
        ({"load": (-5.0, np.nan, 1.0, 9.0)}, "signs"),
    ],
)
def test_a_candidate_that_misses_a_rule_or_whose_number_is_unknown_does_not_meet_it(changes, rule):
    assert not rules(**changes)[rule]


def test_the_load_at_the_approximate_edge_decides_nothing():
    assert has_signs_of_text(slides(load=(-5.0, -2.0, -1.0, 9.0)), LIMITS)


def test_failed_runs_are_counted():
    assert rules(failed=True)["unsolved"] == 2


def table_of_cells(isolated):
    """Cells c0, c1, … of which some are isolated; all are sound, and every second has the signs of the text."""
    rows = [
        {"candidate": f"c{number}", "sound": True, "isolated": apart, "signs": number % 2 == 0}
        for number, apart in enumerate(isolated)
    ]
    return pd.DataFrame(rows)


def test_the_rule_on_replicas_is_dropped_for_all_where_fewer_drawn_cells_meet_it_than_a_share_needs():
    enough = admit(table_of_cells([True, True, True, False]), 3)
    assert enough[SETS[0]].tolist() == [True, True, True, False]
    assert enough[SETS[1]].tolist() == [True, False, True, False]
    few = admit(table_of_cells([True, True, False, False]), 3)
    assert few[SETS[0]].all()
    named = table_of_cells([True, True, True, False]).replace({"candidate": {"c0": "default"}})
    assert admit(named, 3)[SETS[0]].all()
    unsound = table_of_cells([True, True, False, False]).assign(sound=[True, False, True, True])
    assert admit(unsound, 3)[SETS[0]].tolist() == [True, False, True, True]


@pytest.fixture(scope="module")
def judged():
    """Settings and data of the default cell at the quick tier, and a table of it and of another with the same data."""
    own = read("quick")
    data = simulate_candidate(own.job("default", "quick"))
    rows = [
        row
        for cell in (own.candidates[0], replace(own.candidates[0], name="c01", width=9000.0))
        for row in judge_candidate(cell, data, own.claims, "probe", own.limits)
    ]
    return own, data, admit(candidates_table(rows), own.limits.min_isolated)


def test_a_slide_ends_at_the_slip_at_which_the_contact_has_grown_often_enough(judged):
    own, data, _ = judged
    counts, slips = data["probe"].reattachment_count, data["probe"].slip_count
    assert ((counts == own.runs.slips) | (slips == 2 * own.runs.slips)).all()


def test_the_first_slip_of_a_candidate_is_that_of_the_study_of_its_cell(judged):
    _, data, _ = judged
    probe = data["probe"].isel(member=0).sel(slide_approach=0.0)
    assert float(probe.static_friction) == pytest.approx(393.10, rel=1e-2)  # 2048 points, increments of 0.1 nm
    assert float(probe.initial_load) == pytest.approx(-135.03, rel=2e-3)


def test_every_statement_is_judged_in_every_candidate(judged):
    own, _, table = judged
    assert len(table) == 2 * len(own.claims)
    assert set(table.claim) == set(own.claims)
    assert table.margin.notna().sum() > len(own.claims)


def test_the_points_are_halved_at_every_approach(judged):
    _, data, _ = judged
    fine = data["probe"]
    changed = with_grid_change(fine, fine.assign(static_friction=fine.static_friction - 2.0))
    assert np.allclose(changed.static_friction_grid_change, 2.0)
    assert np.allclose(changed.regained_fraction_grid_change, 0.0, equal_nan=True)
    own = data["probe"].static_friction_grid_change.isel(member=0)
    assert np.isfinite(own).all()
    assert np.unique(own).size == own.size


def test_the_figure_shows_all_candidates_and_writes_the_shares(judged, tmp_path):
    own, _, table = judged
    targets = {ending: tmp_path / f"identification.{ending}" for ending in PICTURE_ENDINGS}
    write_identification(identification.figure_job(own, "quick"), table, targets)
    assert all(file.stat().st_size > 0 for file in targets.values())
    assert pd.read_csv(targets["csv"]).claim.tolist() == list(own.claims)


def test_the_table_of_the_package_is_of_the_candidates_and_statements_of_the_config():
    own, table = read(), read_candidates(FILE)
    cells = table.drop_duplicates("candidate")
    held = {row.candidate: (row.width, row.thickness, row.lattice_constant) for row in cells.itertuples()}
    listed = {cell.name: (cell.width, cell.thickness, cell.lattice_constant) for cell in own.candidates}
    assert list(held) == list(listed)[: len(held)]
    assert FILE.read_text(encoding="utf-8").startswith(f"# The first {len(held)} of {len(listed)} candidates")
    assert all(held[name] == listed[name] for name in held)
    assert table.groupby("candidate").claim.apply(list).map(lambda claims: claims == list(own.claims)).all()


def test_a_bad_interface_is_refused(tmp_path):
    text = (ROOT / "config/identification.yaml").read_text(encoding="utf-8")
    (tmp_path / "identification.yaml").write_text(text.replace("probe_weak,", "prob_weak,"), encoding="utf-8")
    (tmp_path / "ch6.yaml").write_text((ROOT / "config/ch6.yaml").read_text(encoding="utf-8"), encoding="utf-8")
    with pytest.raises(InputError, match="prob_weak"):
        identification.read_identification(tmp_path, Plan.read(ROOT / "config", "standard"))


def test_unknown_numbers_are_neither_sound_nor_isolated():
    numbers = AdmissionNumbers(np.nan, np.nan, 0.01, 0.001)
    assert not numbers.is_sound(LIMITS)
    assert not numbers.is_isolated(replace(LIMITS, replicas=1.0))
