"""A study that cannot be is refused when it is read, with file, key, value and what is allowed."""

from __future__ import annotations

import pytest

from contactsim.errors import InputError
from contactsim.solvers.hard_wall.active_set import NestedActiveSet
from contactsim.study.study import Study
from contactsim.traits import Trait
from support.rough_study import GONE, WALKED, refusal, smooth

HURST = "surface.hurst_exponent"
REFUSED = [
    # key, value, words of what is allowed
    ("pionts", 64, "points"),
    ("surface.kind", "cone", "measured, measured_surface, self_affine"),
    ("surface", "flat", "a mapping with `kind`"),
    ("surface.radius", 10.0, "hurst_exponent, long_cutoff"),
    ("surface.rms_height", "10", "a number"),
    ("surface.rng", 1, "no such key"),
    (HURST, 1.2, "from 0 to 1"),
    ("surface.amplitudes", "equal", "gaussian"),
    ("body.kind", "rubber", "half_space"),
    ("body.contact_modulus", -1.0, "positive"),
    ("effects", [], "hard_wall"),
    ("effects", ["magic"], "hard_wall"),
    ("effects", ["hard_wall"] * 2, "twice"),
    ("solver.kind", "guess", "active_set, conjugate_gradients, damped_verlet"),
    ("solver.budget", 2.5, "whole"),
    ("solver.coarsest", 0, "whole number"),
    ("load", {}, "exactly one of"),
    (
        "load",
        {"mean_pressure": [0.1], "reduced_pressure": [0.1]},
        "one of mean_pressure, reduced_pressure, contact_rat",
    ),
    ("load.force", [0.1], "mean_pressure"),
    ("load.mean_pressure", [], "a list of numbers"),
    ("load.mean_pressure", 0.1, "a list of numbers"),
    ("load.mean_pressure", [1, 1.0], "none twice"),
    ("load.mean_pressure", ["1e-3"], "1.0e-3"),
    ("points", 1, "2 or more"),
    ("points", 128.5, "whole number"),
    ("members", 0, "1 or more"),
    ("coarse_grid.members", 3, "at most 2"),
    ("coarse_grid.points", 256, "below"),
    ("coarse_grid.points", 128, "below"),
    ("coarse_grid.points", 1, "whole number"),
    ("coarse_grid.tolerance", 1.0, "points, members"),
    ("vary", [HURST], "a mapping"),
    ("tolerance", 0.0, "a positive number"),
]
"""Studies with one wrong value, which the error names."""
MISSING = {
    "title": "a line of text",
    "load": "mean_pressure",
    "surface.kind": "self_affine",
    "surface.long_cutoff": "number",
    "coarse_grid.members": "at most",
    "tolerance": "a positive number",
}
ALSO_REFUSED = [
    # changes, key, value, words of what is allowed
    ({"load": {"mean_pressure": [0.1, -0.1]}}, "load.mean_pressure", -0.1, "above 0"),
    ({"load": {"mean_pressure": [0.0]}}, "load.mean_pressure", 0.0, "above 0"),
    ({"load": {"reduced_pressure": [0.1, 0]}}, "load.reduced_pressure", 0.0, "above 0"),
    ({"load": {"contact_ratio": [0.1]}}, "load", "contact_ratio", "mean_pressure or reduced_pressure"),
    ({"surface/rms_gradient": GONE}, "surface.rms_gradient", None, "exactly one of"),
    ({"surface/rms_height": 10.0}, "surface.rms_gradient", [0.01, 10.0], "exactly one of"),
    (
        {"surface/rms_gradient": GONE, "surface/rms_height": 0.0},
        "surface.rms_height",
        0.0,
        "positive number, 1e-100 to 1e+100, in nm",
    ),
    ({"vary": {"surface.rms_height": [10.0]}}, "surface.rms_gradient", [0.01, 10.0], "exactly one of"),
    ({"points": 30, "coarse_grid": GONE}, "points", 30, "more than 30: two points per shortest"),
    ({"coarse_grid/points": 30}, "points", 30, "more than 30: two points per shortest"),
    ({"points": GONE, "coarse_grid": GONE}, "points", None, "only a measured surface"),
    ({"vary": {HURST: [0.5, -0.1]}}, HURST, -0.1, "from 0 to 1"),
    ({"vary": {HURST: [0.5, "rough"]}}, HURST, "rough", "a number"),
    ({"vary": {"mood.swing": [1.0]}}, "vary", "mood.swing", HURST),
    ({"vary": {"surface.radius": [1.0]}}, "vary", "surface.radius", HURST),
    ({"vary": {"members": [1, 2]}}, "vary", "members", "points, "),
    ({"vary": {"surface": [1.0]}}, "vary", "surface", HURST),
    ({"vary": {1: [2.0]}}, "vary", 1, HURST),
    ({"vary": {HURST: 0.5}}, f"vary.{HURST}", 0.5, "a list with at least one"),
    ({"vary": {HURST: []}}, f"vary.{HURST}", [], "a list with at least one"),
    ({"vary": {HURST: [[0.2, 0.5]]}}, f"vary.{HURST}", [0.2, 0.5], "single values"),
    ({"vary": {HURST: [0.5, 0.5]}}, f"vary.{HURST}", [0.5, 0.5], "none twice"),
    ({"vary": {HURST: [1, 1.0]}}, f"vary.{HURST}", [1, 1.0], "twice"),
    ({"solver": {"kind": "verlet", "reduction": 0.1}}, "solver.reduction", 0.1, "damping"),
    ({"solver": {"kind": "verlet", "_stiffness": 1}}, "solver._stiffness", 1, "damping"),
    ({"solver": {"kind": "verlet", "time_step": 1.5}}, "solver.time_step", 1.5, "stability"),
    ({"fit_limits": [-1.0]}, "fit_limits", [-1.0], "largest reduced pressures"),
]


def refused_studies():
    """Changes with what their error says: file, key, value and what is allowed."""
    for key, value, allowed in REFUSED:
        section, _, inner = key.partition(".")
        change = (
            {section: {inner: value}} if section in ("load", "solver") and inner else {key.replace(".", "/"): value}
        )
        yield pytest.param({"vary": {}} | change, key, value, allowed, id=f"{key}={value}")
    for key, allowed in MISSING.items():
        yield pytest.param({key.replace(".", "/"): GONE}, key, "nothing", allowed, id=f"no {key}")
    for changes, key, value, allowed in ALSO_REFUSED:
        yield pytest.param(changes, key, value, allowed, id=f"{key}={value}")


@pytest.mark.parametrize(("changes", "key", "value", "allowed"), [*refused_studies()])
def test_a_bad_study_is_refused_with_file_key_value_and_what_is_allowed(changes, key, value, allowed):
    error = refusal(changes)
    assert (error.file, error.key, error.value) == ("ch9.yaml", f"studies.rough.{key}", value)
    assert str(error).startswith(f"ch9.yaml: studies.rough.{key}: got ")
    assert allowed in str(error)


@pytest.mark.parametrize(
    ("changes", "key", "effects"),
    [
        ({"snapshots": [0.1]}, "snapshots", "hard_wall"),
        ({"increments": {"kind": "requested"}}, "increments", "hard_wall"),
        ({"snapshot_members": 1}, "snapshot_members", "hard_wall"),
        (WALKED | {"keep": ["contact"]}, "keep", "normal_cohesive_zone"),
    ],
)
def test_keys_that_the_effects_have_no_use_for_are_refused(changes, key, effects):
    error = refusal(changes)
    assert (error.key, error.value) == (f"studies.rough.{key}", changes[key])
    assert error.allowed == f"no such key, as effects are {effects}"


def nested(**options):
    return {"increments": {"kind": "nested", "full_grid_at": [-4.0]} | options}


COUPLED = {"effects": ["cohesive_zone"], "normal_cohesive_zone": {}, "cohesive_zone": {"work_of_separation": 1.0}}
LOADED = {"increments": {"kind": "adaptive"}, "path": {"mean_pressure": [0.0, 0.1], "increment": 0.1}}


@pytest.mark.parametrize(
    ("changes", "key", "allowed"),
    [
        (nested(full_grid_at=[-4.2]), "increments.full_grid_at", "steps of the path"),
        (nested(coarse_ratio=128), "increments.coarse_ratio", "divides half the grid"),
        (nested(coarse_tolerance=0.5), "increments.coarse_tolerance", "at most 0.1"),
        ({"increments": {"kind": "adaptive"}, "solver": {"kind": "damped_verlet"}}, "increments", "no predictions"),
        (LOADED, "increments.least", "least and most in GPa"),
        ({"tolerance": 0.5}, "tolerance", "at most 0.1"),
        (COUPLED, "body.poisson_ratio", "of the lower body: it moves along x"),
        ({"snapshots": [-4.5, 3.0]}, "snapshots", "values near steps of the path; the nearest is -4"),
    ],
)
def test_a_path_that_cannot_be_walked_is_refused_when_the_study_is_read(changes, key, allowed):
    error = refusal(WALKED | changes)
    assert (error.file, error.key) == ("ch9.yaml", f"studies.rough.{key}")
    assert allowed in error.allowed


@pytest.mark.parametrize("section", [None, [], "a study"])
def test_a_study_that_is_no_mapping_is_refused(section):
    with pytest.raises(InputError, match=r"^ch9\.yaml: studies\.rough: got "):
        Study.read("rough", section, "ch9.yaml", 1)


def test_a_solver_that_does_not_accept_the_scene_is_refused_with_the_trait(monkeypatch):
    monkeypatch.setattr(NestedActiveSet, "accepts", NestedActiveSet.accepts - {Trait.MEAN_PRESSURE})
    error = refusal({})
    assert (error.file, error.key, error.value) == ("ch9.yaml", "studies.rough.solver", "NestedActiveSet")
    assert "MEAN_PRESSURE" in str(error)


def test_reduced_pressures_on_a_flat_surface_are_refused():
    with pytest.raises(InputError, match=r"load.*reduced_pressure.*allowed"):
        smooth("flat", {"reduced_pressure": [0.1]})


@pytest.mark.parametrize(
    "changes",
    [{"vary": {}}, {"load": {"mean_pressure": [1e-3]}}, {"vary": {"surface.rms_gradient": [0.1, 0.2]}}],
    ids=["nothing varied", "no reduced pressure", "another key varied"],
)
def test_fits_that_aggregation_cannot_make_are_refused_before_anything_runs(changes):
    assert refusal({"fit_limits": [1.0]} | changes).key == "studies.rough.fit_limits"


def test_a_fit_limit_below_two_of_the_loads_is_refused():
    changes = {"vary": {"surface.hurst_exponent": [0.2, 0.8]}, "fit_limits": [0.05]}
    assert refusal(changes).key == "studies.rough.fit_limits"
