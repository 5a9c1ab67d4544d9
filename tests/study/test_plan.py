from __future__ import annotations

import inspect
from copy import deepcopy
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest
import yaml

from contactsim.elasticity.half_space import HalfSpace
from contactsim.elasticity.layer import Layer
from contactsim.errors import InputError
from contactsim.provenance import canonical
from contactsim.study.plan import Plan
from support import rough_study
from support.places import ROOT

CONFIG = ROOT / "config"
SMOOTH = {
    "title": "Cylinder",
    "surface": {"kind": "cylinder", "radius": 10.0, "length": 40.0},
    "body": {"kind": "half_space", "contact_modulus": 1.0},
    "effects": ["hard_wall"],
    "load": {"contact_ratio": [0.1, 0.2]},
    "points": 64,
    "members": 2,
    "tolerance": 1e-3,
}
ROUGH = SMOOTH | {
    "title": "Rough",
    "surface": rough_study.ROUGH["surface"],
    "load": {"reduced_pressure": [0.01, 0.1]},
    "vary": {"surface.hurst_exponent": [0.2, 0.8]},
    "solver": {"kind": "polonsky_keer"},
}
FIGURE = {"study": "smooth", "title": "Figure", "caption": "What it shows.", "size": [4.0, 3.0]}
ROUND = {"module": "round_contacts"}
TWICE = FIGURE | ROUND | {"datasets": ["smooth"], "size": [3.0, 3.0]}
FILES = {
    "config.yaml": {"seed": 1, "tier": "plain", "results": "made"},
    "tiers.yaml": {"plain": {}, "small": {"studies": {"smooth": {"points": 32}}}},
    "ch3.yaml": {
        "studies": {"smooth": SMOOTH, "rough": ROUGH},
        "figures": {"fig_3_1": TWICE, "fig_3_3": FIGURE | {"study": "rough", "select": {"hurst_exponent": [0.1, 0.5]}}},
    },
}


@pytest.fixture
def folder(tmp_path):
    """Write a config folder: the files above with some values changed, given as {file: {slashed/key: value}}."""

    def write(changes=(), files=FILES, name="config"):
        files = deepcopy(files)
        for file, values in dict(changes).items():
            for path, value in values.items():
                *outer, last = path.split("/")
                inner = files.setdefault(file, {})
                for key in outer:
                    inner = inner[key]
                inner[last] = value
        target = tmp_path / name
        target.mkdir(exist_ok=True)
        for file, content in files.items():
            (target / file).write_text(yaml.safe_dump(content, sort_keys=False))
        return target

    return write


def refusal(folder, tier=None):
    with pytest.raises(InputError) as caught:
        Plan.read(folder, tier)
    return caught.value


# --- the config of this project -----------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def tiers():
    return {tier: Plan.read(CONFIG, tier) for tier in ("quick", "standard", "full")}


def test_the_project_has_the_three_tiers_and_reads_at_each(tiers):
    assert list(yaml.safe_load((CONFIG / "tiers.yaml").read_text())) == list(tiers)
    for tier, plan in tiers.items():
        assert plan.tier == tier
        assert plan.results == Path("results") / tier
        assert set(plan.studies) == set(plan.chapters)
        assert all(study.runs() for study in plan.studies.values())


def test_the_tier_is_that_of_the_config_unless_told(tiers):
    plan = Plan.read(CONFIG)
    assert plan.tier == yaml.safe_load((CONFIG / "config.yaml").read_text())["tier"]
    assert plan.figures == tiers[plan.tier].figures


def test_quick_keeps_every_figure_every_varied_value_and_at_least_three_members_two_of_surfaces_and_paths(tiers):
    quick, standard = tiers["quick"], tiers["standard"]
    assert quick.figures == standard.figures
    assert quick.studies.keys() == standard.studies.keys()
    for name, study in quick.studies.items():
        asked = standard.studies[name].settings
        assert study.settings["vary"].keys() == asked["vary"].keys()
        few = asked["path"] is not None  # its variants alone make a path's cost
        for key, values in study.settings["vary"].items():
            wanted = asked["vary"][key]
            assert key == "points" or (set(values) <= set(wanted) if few else values == wanted)
        least = 2 if study.settings["surface"].get("dimensions") == 2 or asked["path"] is not None else 3
        least = 1 if study.settings["vary"].get("points") else least  # it is grids that it compares
        assert study.settings["members"] >= min(least, asked["members"])
        dropped = study.settings["coarse_grid"] is None  # of a path, which costs as much on any grid, it may be
        assert dropped == (asked["coarse_grid"] is None) or (dropped and few)
        assert study.settings["fit_limits"] == asked["fit_limits"]


def test_standard_has_at_least_the_points_of_the_thesis_on_lines_and_no_tier_is_coarser_than_the_one_before(tiers):
    for name, study in tiers["standard"].studies.items():
        points = [max(run.settings["points"] for run in plan.studies[name].runs()) for plan in tiers.values()]
        assert points == sorted(points)
        assert points[0] < points[-1] or study.settings["thesis_points"] is None
        if study.settings["surface"]["kind"] != "sphere" and "dimensions" not in study.settings["surface"]:
            assert points[1] >= (study.settings["thesis_points"] or 0)


def test_every_tier_has_the_loads_that_a_figure_selects_and_a_fit_needs(tiers):
    for plan in tiers.values():
        for figure in filter(lambda one: one.studies, plan.figures.values()):
            study = plan.studies[figure.settings["study"]].settings
            least, largest = figure.settings["select"].get(study["load"]["name"], (-float("inf"), float("inf")))
            shown = sum(least <= value <= largest for value in study["load"]["values"])
            one = "fields" in study["keep"] and figure.settings["film"] is None
            few = one, study["slide"] is not None  # a slide goes on from where a path ends
            assert shown == 1 if few[0] else shown >= (1 if few[1] else 3)


def test_every_figure_has_a_function_that_takes_data_axes_and_the_values_of_the_thesis(tiers):
    figures = tiers["standard"].figures
    assert figures
    for name, figure in figures.items():
        draw = getattr(import_module(figure.module), name)
        shown = max(len(figure.studies), 1)  # a law by itself is one dataset too
        _, *beside, axes = list(inspect.signature(draw).parameters)[: shown + 1]
        assert (len(beside), axes) == (shown - 1, "axes")
        film = [] if figure.settings["film"] is None else ["frame"]
        assert list(inspect.signature(draw).parameters)[shown + 1 :] == [*film, *figure.settings["reference"]]
        assert draw.__doc__


def test_no_two_runs_of_a_plan_write_one_file(tiers):
    for plan in tiers.values():
        stems = [run.stem for study in plan.studies.values() for run in study.runs()]
        assert len(set(stems)) == len(stems)


def test_figure_5_2_has_the_thesis_geometry_and_a_body_as_good_as_a_half_space(tiers):
    settings = tiers["standard"].studies["nonadhesive_compressible"].settings
    surface, vary = settings["surface"], settings["vary"]
    assert surface["length"] == 8 * surface["long_cutoff"] == 8 * 512 * surface["short_cutoff"]
    assert settings["points"] * surface["short_cutoff"] == 32 * surface["length"]
    assert vary["surface.hurst_exponent"] == [0.2, 0.8]
    assert vary["body.poisson_ratio"] == [0.1, 0.45]
    longest = 2 * np.pi / surface["length"]
    thick = settings["body"] | {"thickness": max(vary["body.thickness"])}
    thick.pop("kind")
    symbol = Layer(**thick).compliance(np.array([longest]))
    assert symbol == pytest.approx(HalfSpace(thick["contact_modulus"]).compliance(np.array([longest])), rel=1e-15)


# --- reading ------------------------------------------------------------------------------------------------------


def test_a_plan_lists_studies_figures_and_chapters(folder):
    plan = Plan.read(folder())
    assert plan.tier == "plain"
    assert plan.results == Path("made/plain")
    assert plan.chapters == {"smooth": "ch3", "rough": "ch3"}
    assert {name: figure.chapter for name, figure in plan.figures.items()} == {"fig_3_1": "ch3", "fig_3_3": "ch3"}
    unsaid = {"panels": 1, "rows": 1, "select": {}, "reference": {}, "datasets": [], "law": None, "film": None}
    shown = plan.figures["fig_3_1"]
    assert shown.module == "contactsim.figures.round_contacts"
    assert shown.settings | ROUND == unsaid | TWICE
    assert plan.dataset_name("smooth") == "ch3_smooth"


def test_a_tier_overrides_what_it_names_and_nothing_else(folder):
    plain, small = (Plan.read(folder(), tier) for tier in ("plain", "small"))
    assert small.studies["smooth"].settings == plain.studies["smooth"].settings | {"points": 32}
    assert small.studies["rough"] == plain.studies["rough"]


def test_a_run_is_found_by_the_parts_of_its_file_name(folder):
    plan = Plan.read(folder())
    for run in plan.studies["rough"].runs():
        assert plan.run(*run.stem.split("/")) == run


def test_runs_alike_differ_in_their_loads_alone_also_those_of_another_study(folder):
    finer = ROUGH | {
        "same_surfaces_as": "rough",
        "points": 128,
        "coarse_grid": {"points": 64, "members": 1},
        "members": 1,
    }
    others = {
        "finer": finer | {"load": {"reduced_pressure": [0.1, 0.3]}},
        "tighter": ROUGH | {"same_surfaces_as": "rough", "tolerance": 1e-4},
        "own_surfaces": ROUGH,
        "kept": ROUGH | {"same_surfaces_as": "rough", "keep": ["contact"]},
        "without_profile": ROUGH | {"same_surfaces_as": "rough", "keep": ["contact", "pressure"], "members": 1},
        "mean": ROUGH | {"same_surfaces_as": "rough", "load": {"mean_pressure": [0.1]}},
    }
    plan = Plan.read(folder({"ch3.yaml": {f"studies/{name}": study for name, study in others.items()}}))
    groups = {frozenset([stem, *stems]) for stem, stems in plan.runs_alike.items()}
    coarse = [run.stem for run in plan.studies["finer"].runs() if run.measures_error]
    members = [
        [run.stem for run in plan.studies[name].runs() if run.member == 0] for name in ("rough", "without_profile")
    ]
    assert groups == set(map(frozenset, zip(*members, coarse, strict=True)))
    assert len(groups) == 2
    assert all(stem not in stems for stem, stems in plan.runs_alike.items())


LAW = {"effect": "cohesive_zone", "work_of_separation": 1.0, "work_ratio": 1.0, "reach": 5.0}
LAW |= {"normal_gap": [0.0], "tangential_gap": [0.0, 0.5]}
ALONE = {key: value for key, value in FIGURE.items() if key != "study"} | {"law": LAW, "size": [4.0, 3.0]}


def test_a_chapter_without_studies_draws_a_law(folder):
    plan = Plan.read(folder({"ch2.yaml": {"figures": {"fig_2_2": ALONE}}}))
    assert plan.figures["fig_2_2"].studies == []
    other = folder({"ch2.yaml": {"figures": {"fig_2_2": ALONE | {"law": LAW | {"work_ratio": 0.5}}}}}, name="other")
    assert plan.figure_settings("fig_2_2")["settings"]["law"]["normal_length"] == 1.0
    assert plan.figure_settings("fig_2_2") != Plan.read(other).figure_settings("fig_2_2")


def overrides(study, value):
    """A tier that overrides a study."""
    return {"tiers.yaml": {"plain": {"studies": {study: value}}}}


def of_law(key, value):
    """A chapter with the figure of a law with one value changed."""
    figure = ALONE | {key: value} if key != "law" else ALONE | {"law": LAW | value}
    return {"ch2.yaml": {"figures": {"fig_2_2": figure}}}


REFUSED = [
    # file, key, value, words of what is allowed
    ("config.yaml", "sede", 1, "seed, tier, results"),
    ("config.yaml", "seed", -1, "0 or more"),
    ("config.yaml", "seed", 2**63, "at most 9223372036854775807"),
    ("config.yaml", "data_folders", "scans", "a list of folders"),
    ("ch3.yaml", "studies.rough.members", 5001, "at most 10000 runs in all, and there are 2 variants"),
    ("ch3.yaml", "studies.smooth.points", 10**12, "at most 1073741824 points of the whole grid"),
    ("ch3.yaml", "studies.smooth.body.contact_modulus", 0, "positive"),
    ("ch3.yaml", "figures.fig_3_1.rows", 51, "at most 50"),
    ("tiers.yaml", "plain.study", {}, "known keys: studies"),
    ("tiers.yaml", "plain", [1], "a mapping"),
    ("ch3.yaml", "clams", {}, "studies, figures, claims"),
    ("ch3.yaml", "studies.rough.members", 0, "1 or more"),
    ("ch3.yaml", "studies.rough", 5, "a mapping"),
    ("ch3.yaml", "studies.rough.same_surfaces_as", "rogh", "one of smooth"),
    ("ch3.yaml", "studies.rough.same_surfaces_as", "rough", "one of smooth"),
    ("ch3.yaml", "studies.rough.same_surfaces_as", "smooth", "the same `surface`, self_affine"),
    ("ch3.yaml", "figures.fig_3_1", 3, "a mapping"),
    ("ch3.yaml", "figures.fig_3_1.study", "smoth", "smooth, rough"),
    ("ch3.yaml", "figures.fig_3_1.colour", "red", "select"),
    ("ch3.yaml", "figures.fig_3_1.compare", "kappa_r", "a list of columns"),
    ("ch3.yaml", "figures.fig_3_1.panels", 0, "axes"),
    ("ch3.yaml", "figures.fig_3_3.datasets", ["smooth"], "draws: data"),
]
"""Configs with one wrong value, which the error names."""
SIZES = ([101.0, 3.0], [4.0], [4.0, 3.0, 2.0], 4.0, ["4.0", 3.0], [4.0, None], [], [4.0, -3.0], [0.0, 3.0])
LIMITS = ([0.1], [0.1, 0.2, 0.3], 0.1, {"least": 0.1}, [0.1, "all"], None, [0.5, 0.1])
REFUSED += [("ch3.yaml", "figures.fig_3_1.size", size, "width and height") for size in SIZES]
REFUSED += [("ch3.yaml", "figures.fig_3_3.select.hurst_exponent", value, "least and largest value") for value in LIMITS]
ELSEWHERE = {"studies": {"other": SMOOTH}, "figures": {"fig_9_1": FIGURE | {"study": "other"}}}
SIZELESS = {"study": "smooth", "title": "T", "caption": "C"}
NEITHER = {"title": "Figure", "caption": "What it shows.", "size": [4.0, 3.0]}
NAMES = "fig_3_2, fig_3_4"
ALSO_REFUSED = [
    # changes, file, key, value, words of what is allowed
    ({"config.yaml": {"tier": "huge"}}, "config.yaml", "tier", "huge", "one of plain, small, the tiers of"),
    (overrides("smoth", {"points": 8}), "tiers.yaml", "plain.studies.smoth", {"points": 8}, "smooth, rough"),
    (
        {"tiers.yaml": {"small": {"studies": {"smoth": {}}}}},
        *("tiers.yaml", "small.studies.smoth", {}, "no such study, but smooth, rough"),
    ),
    ({"tiers.yaml": {"a b": {}}}, "tiers.yaml", "name of a tier", "a b", "letters, digits"),
    ({"tiers.yaml": {"small": 5}}, "tiers.yaml", "small", 5, "a mapping"),
    (
        {"ch3.yaml": {"studies/smooth/body": {"kind": "half_space"}}},
        *("ch3.yaml", "studies.smooth.body.contact_modulus", "nothing", "exactly one of"),
    ),
    (
        {"ch3.yaml": {"studies/smooth/body": {"kind": "half_space", "contact_modulus": 1, "youngs_modulus": 1}}},
        *("ch3.yaml", "studies.smooth.body.contact_modulus", "both", "exactly one of"),
    ),
    ({"ch3.yaml": {"studies/a b": SMOOTH}}, "ch3.yaml", "studies", "a b", "letters, digits and underscores"),
    ({"ch3.yaml": {f"studies/{'x' * 81}": SMOOTH}}, "ch3.yaml", "studies", "x" * 81, "1 to 80 letters"),
    ({"ch3.yaml": {"claims": {"a|b": {}}}}, "ch3.yaml", "claims", "a|b", "letters, digits and underscores"),
    (overrides("smooth", 5), "tiers.yaml", "plain.studies.smooth", 5, "a mapping"),
    (overrides("smooth", {"pionts": 8}), "tiers.yaml", "studies.smooth.pionts", 8, "points"),
    (overrides("rough", {"points": 8}), "tiers.yaml", "studies.rough.points", 8, "more than 30"),
    ({"ch3.yaml": {"figures/fig_3_99": FIGURE}}, "ch3.yaml", "figures.fig_3_99", "fig_3_99", NAMES),
    ({"ch3.yaml": {"figures/_cylinder": FIGURE}}, "ch3.yaml", "figures._cylinder", "_cylinder", "fig_3_2"),
    ({"ch9.yaml": ELSEWHERE}, "ch9.yaml", "figures.fig_9_1", "fig_9_1", "contactsim.figures.ch9"),
    ({"ch3.yaml": {"figures/fig_3_1": SIZELESS}}, "ch3.yaml", "figures.fig_3_1.size", "nothing", "width and height"),
    (
        {"ch3.yaml": {"figures/fig_3_1": FIGURE | ROUND}},
        "ch3.yaml",
        "figures.fig_3_1.datasets",
        [],
        "draws: line, surface",
    ),
    (
        {"ch2.yaml": {"figures": {"fig_2_2": NEITHER}}},
        *("ch2.yaml", "figures.fig_2_2", {"study": None, "law": None}, "exactly one of study and law"),
    ),
    (of_law("law", {"effect": "glue"}), "ch2.yaml", "figures.fig_2_2.law.effect", "glue", "one of cohesive_zone"),
    (
        of_law("law", {"work_ratio": 0.0}),
        *("ch2.yaml", "figures.fig_2_2.law", LAW | {"work_ratio": 0.0}, "exerts both"),
    ),
    (
        of_law("law", {"work_of_separation": -1.0}),
        *("ch2.yaml", "figures.fig_2_2.law.work_of_separation", -1.0, "a positive number"),
    ),
    (
        of_law("select", {"hurst_exponent": [0, 1]}),
        *("ch2.yaml", "figures.fig_2_2.select.hurst_exponent", [0, 1], "no such key"),
    ),
]
for file, key, value, allowed in REFUSED:
    ALSO_REFUSED.append(({file: {key.replace(".", "/"): value}}, file, key, value, allowed))


@pytest.mark.parametrize(("changes", "file", "key", "value", "allowed"), ALSO_REFUSED)
def test_a_bad_config_is_refused_with_file_key_value_and_what_is_allowed(folder, changes, file, key, value, allowed):
    written = folder(changes)
    error = refusal(written)
    assert str(written / file) in str(error.file)
    assert (error.key, error.value) == (key, value)
    assert allowed in error.allowed
    assert str(error).startswith(f"{error.file}: {key}: got ")


MAP = {
    "waves": SMOOTH
    | {
        "surface": {"kind": "sinusoid", "length": 64.0, "amplitude": 1.0, "dimensions": 2},
        "load": {"mean_pressure": [0.01, 0.02]},
        "members": 1,
        "keep": ["fields"],
    }
}
ONE = {"study": "waves", "size": [9.0, 3.0], "panels": 3, "select": {"mean_pressure": [0.02, 0.02]}}


@pytest.mark.parametrize(
    ("study", "figure", "key", "value", "allowed"),
    [
        ({"keep": ["contact"]}, {}, "study", "waves", "keeps `fields`"),
        ({"surface": {"kind": "sinusoid", "length": 64.0, "amplitude": 1.0}}, {}, "study", "waves", "not lines"),
        ({}, {"select": {}}, "select", {}, "one load of one member to draw; this leaves 2"),
        ({}, {"select": {"mean_pressure": [0.1, 1.0]}}, "select", {"mean_pressure": [0.1, 1.0]}, "this leaves 0"),
        ({"members": 2}, {}, "select", ONE["select"], "this leaves 2"),
    ],
)
def test_a_map_of_what_cannot_be_drawn_as_one_is_refused_before_anything_is_solved(
    folder, study, figure, key, value, allowed
):
    files = FILES | {"ch3.yaml": {"studies": MAP, "figures": {"maps": FIGURE | ONE}}, "tiers.yaml": {"plain": {}}}
    assert Plan.read(folder(files=files)).figures["maps"].settings["select"] == ONE["select"]
    changes = {f"studies/waves/{name}": entry for name, entry in study.items()}
    changes |= {f"figures/maps/{name}": entry for name, entry in figure.items()}
    written = folder({"ch3.yaml": changes}, files)
    error = refusal(written)
    assert (error.key, error.value) == (f"figures.maps.{key}", value)
    assert allowed in error.allowed
    assert error.file == written / "ch3.yaml"


def test_a_figure_that_selects_along_what_its_study_does_not_have_is_refused(folder):
    error = refusal(folder({"ch3.yaml": {"figures/fig_3_3/select": {"speed": [0.1, 0.2]}}}))
    assert error.key == "figures.fig_3_3.select.speed"


def test_an_unknown_tier_on_the_command_line_names_tiers_yaml_and_what_exists(folder):
    written = folder()
    error = refusal(written, "huge")
    assert str(error) == f"tier: got 'huge'; allowed: one of plain, small, the tiers of {written / 'tiers.yaml'}"


def test_an_error_in_an_overridden_study_names_the_chapter_the_tier_and_the_file_of_tiers(folder):
    written = folder(overrides("smooth", {"members": 0}))
    message = str(refusal(written))
    for part in (str(written / "ch3.yaml"), "tier plain", str(written / "tiers.yaml"), "studies.smooth.members"):
        assert part in message


@pytest.mark.parametrize("file", ["config.yaml", "tiers.yaml"])
def test_a_missing_file_is_named(folder, file):
    written = folder()
    (written / file).unlink()
    assert refusal(written).file == written / file


def test_a_name_of_a_study_used_in_two_chapters_is_refused(folder):
    error = refusal(folder({"ch4.yaml": {"studies": {"smooth": SMOOTH}, "figures": {}}}))
    assert error.key == "studies.smooth"
    assert "ch4.yaml" in str(error)


# --- what the workflow is given -----------------------------------------------------------------------------------


def reordered(content):
    """The same content with the keys of every mapping in the opposite order."""
    if isinstance(content, dict):
        return {key: reordered(value) for key, value in reversed(content.items())}
    return content


def everything(plan):
    return {name: canonical(plan.study_settings(name)) for name in plan.studies} | {
        name: canonical(plan.figure_settings(name)) for name in plan.figures
    }


def run_params(plan):
    return {run.stem: canonical([run.settings, run.source]) for study in plan.studies.values() for run in study.runs()}


def test_nothing_changes_when_the_keys_of_the_config_are_reordered(folder):
    one = Plan.read(folder(name="a"))
    other = Plan.read(folder(files=reordered(FILES), name="b"))
    assert everything(one) == everything(other)
    assert run_params(one) == run_params(other)


def test_what_the_workflow_is_given_is_the_same_read_twice(folder):
    written = folder()
    assert everything(Plan.read(written)) == everything(Plan.read(written))


def test_a_study_lists_each_run_with_its_files_and_digest(folder):
    plan = Plan.read(folder())
    settings = plan.study_settings("rough")
    for listed, run in zip(settings["runs"], plan.studies["rough"].runs(), strict=True):
        assert listed == {
            "path": f"made/plain/runs/{run.stem}.nc",
            "costs": f"made/plain/costs/runs/{run.stem}.json",
            "coordinates": run.coordinates,
            "member": run.member,
            "measures_error": run.measures_error,
            "error": run.error,
            "digest": run.digest,
        }
    assert {settings["settings"][key] for key in ("name", "tier", "seed")} == {"rough", "plain", 1}


@pytest.mark.parametrize("name", ["fig_3_1", "a-b", "compute_all", "setup"])
def test_a_study_cannot_have_the_name_of_a_figure_rule_or_target(folder, name):
    written = folder({"ch3.yaml": {f"studies/{name}": SMOOTH}})
    (written.parent / "Makefile").write_text("CORES := 2\nsetup: .venv\n")
    (written.parent / "Snakefile").write_text("rule compute_all:\n    input: []\n")
    error = refusal(written)
    assert (error.key, error.value) == ("studies", name)
    assert error.allowed == "1 to 80 letters, digits and underscores; no figure's name and none of compute_all, setup"


def test_the_names_of_this_project_s_rules_and_targets_are_reserved(tiers):
    names = set(tiers["standard"].reserved_names)
    assert {"all", "overview", "simulate_member", "draw_work_precision", "setup", "test", "help"} <= names
    assert not names & {"CORES", "PHONY", "Makefile"}
