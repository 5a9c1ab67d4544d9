"""Load curves of one study beside those of another, over the largest load of these."""

from __future__ import annotations

import json

import numpy as np
import pytest
import xarray as xr

from contactsim.analysis import claims
from contactsim.errors import InputError
from contactsim.observables.body_readings import CURVE_APPROACHES
from contactsim.study.claim_plan import read_claim
from support.claims import PLAN

STUDIES = {name: PLAN.studies[name] for name in ("rough_adhesive", "rough_wall", "rough_repulsive")}
WORKS = [0.07, 10.5]
CURVES = {
    "source": "Section 0",
    "statement": "Load curves do not differ.",
    "rationale": "A test.",
    "study": "rough_adhesive",
    "departs_from": "rough_wall",
    "quantity": "pressure_curve",
    "reduce": "largest_difference",
    "along": "work_of_separation",
    "at_most": 0.1,
}


def claim(**changes):
    section = {key: value for key, value in (CURVES | changes).items() if value is not None}
    return read_claim("test", section, "ch5.yaml", STUDIES).settings


def curves_of(slopes):
    """Straight load curves of three members; slopes: one, or one for each work."""
    slopes = np.asarray(slopes, float)
    pressure = slopes[..., None, None] * CURVE_APPROACHES * np.ones((3, 1))
    dims = ("work_of_separation",) * slopes.ndim + ("member", "curve_approach")
    changes = {"pressure_curve_grid_change": np.zeros_like(pressure.mean(-2))}
    data = xr.Dataset(
        {"pressure_curve": (dims, pressure), "pressure_curve_increment_error": (dims, 0 * pressure)}
        | {name: ((*dims[:-2], dims[-1]), values) for name, values in changes.items()},
        {"member": range(3), "curve_approach": CURVE_APPROACHES},
    )
    data = data.assign(status=((*dims[:-1], "step"), np.zeros((*pressure.shape[:-1], 5), np.int8)))
    settings = {"surface": {"kind": "self_affine"}, "coarse_grid": {"members": 2}, "thesis_points": 8}
    data = data.assign(points=8, **{"work_of_separation": WORKS} if slopes.ndim else {})
    return data.assign_attrs(problem="cohesive", settings=json.dumps(settings))


def judged(settings, adhesive, wall):
    return claims.judge_claims({"test": settings}, {"rough_adhesive": adhesive, "rough_wall": wall}).iloc[0]


@pytest.mark.parametrize(
    ("slopes", "value"), [([0.9, 0.8], 0.2), ([1.1, 0.8], 0.3), ([1.1, 1.2], 0.2), ([1.0, 1.0], 0.0)]
)
def test_the_largest_difference_is_that_of_any_two_curves_over_the_largest_load(slopes, value):
    row = judged(claim(), curves_of(slopes), curves_of(1.0))
    assert row.value == pytest.approx(value)
    assert row.verdict == (claims.NOT_REPRODUCED if value > 0.1 else claims.REPRODUCED)
    assert row.measure.startswith("largest_difference of pressure_curve in rough_adhesive beside rough_wall")
    assert row.departs_from == "rough_wall"


def test_the_largest_load_is_that_of_each_curve_which_is_compared():
    settings = claim(reduce="largest_size", along=None)
    assert judged(settings, curves_of([0.5, 4.0]), curves_of([1.0, 5.0])).value == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"quantity": "pressure_at_12nm"}, "pressure_curve"),
        ({"departs_from": None, "minus": "rough_wall"}, "departs_from"),
        ({"minus": "rough_repulsive"}, "one of them"),
    ],
)
def test_only_curves_depart_and_only_departures_have_a_largest_difference(changes, words):
    with pytest.raises(InputError, match=words):
        claim(**changes)
