"""What effects cost: scenes have what their settings list, poorer scenes take less, and the figure shows it."""

from __future__ import annotations

import json

import numpy as np
import pandas as pd
import pytest

from contactsim import dataset
from contactsim.evaluation.effects import effect_cost
from contactsim.figures.diagnostics.effects import write_effects
from contactsim.study.figure_plan import PICTURE_ENDINGS
from support.places import ROOT

QUICK = {"repeats": 1, "scene": {"points": 256, "path": {"increment": 0.25}, "tolerance": 1e-6}}
COSTS = effect_cost.read_variants(ROOT / "config", 0, QUICK, "quick")
FLAGS = ("has_adhesion", "has_friction", "has_coupling", "has_second_body", "has_height")


@pytest.fixture(scope="module")
def measured():
    job = json.loads(json.dumps(effect_cost.effects_job(COSTS)))
    return effect_cost.measure_effects(effect_cost.CostJob.from_settings(job["settings"]))


def test_each_variant_lacks_what_its_name_says_and_nothing_else(measured):
    data, _ = measured
    has = {name: tuple(int(data[flag].sel(variant=name)) for flag in FLAGS) for name in data.variant.values}
    assert has == {
        "all_effects": (1, 1, 1, 1, 1),
        "one_body": (1, 1, 1, 0, 1),
        "without_friction": (1, 0, 1, 1, 1),
        "without_coupling": (1, 1, 0, 1, 1),
        "half_spaces": (1, 1, 1, 1, 0),
        "normal_adhesion": (1, 0, 0, 0, 1),
        "hard_wall": (0, 0, 0, 0, 1),
    }


def test_a_scene_without_an_effect_does_not_pay_for_it(measured):
    data, _ = measured
    work = {name: float(data.transforms.sel(variant=name)) for name in data.variant.values}
    unknowns = {name: int(data.unknowns.sel(variant=name)) for name in data.variant.values}
    assert unknowns["without_friction"] == unknowns["normal_adhesion"] == unknowns["all_effects"] / 2
    assert work["normal_adhesion"] < work["without_friction"] < work["all_effects"]
    assert int(data.unconverged.sum()) == 0


def test_leaving_out_adhesion_leaves_no_pull_and_a_smaller_contact(measured):
    data, _ = measured
    pulls, lengths = data.largest_pull, data.contact_length_at_load
    assert float(pulls.sel(variant="hard_wall")) == 0
    assert pulls.drop_sel(variant="hard_wall").min() > 100
    assert float(lengths.sel(variant="hard_wall")) < 0.6 * float(lengths.sel(variant="all_effects"))


def test_the_figure_compares_every_scene_with_the_first(measured, tmp_path):
    data, spent = measured
    dataset.write(dataset.stamp(data, "effects", {}, "source"), tmp_path / "effects.nc")
    (tmp_path / "effects.json").write_text(json.dumps(spent))
    targets = {kind: str(tmp_path / f"effects.{kind}") for kind in PICTURE_ENDINGS}
    plan = effect_cost.effects_figure_job(COSTS, "quick")
    write_effects(plan, str(tmp_path / "effects.nc"), str(tmp_path / "effects.json"), targets)
    shown = pd.read_csv(targets["csv"])
    assert shown.title.tolist() == [variant.title for variant in COSTS.variants]
    assert shown.cost[0] == 1
    assert shown.largest_pull_change[0] == shown.contact_length_at_load_change[0] == 0
    assert np.allclose(shown.cost * shown.transforms[0], shown.transforms)
    assert shown.largest_pull_change.iloc[-1] == -1
