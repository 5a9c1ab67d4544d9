"""A bundle is whole, can be checked, says what it holds, and can be used without the code that made it."""

from __future__ import annotations

import ast
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import xarray as xr
import yaml
from rocrate.rocrate import ROCrate
from scipy.stats import linregress

from contactsim import dataset
from contactsim.analysis import aggregate, costs
from contactsim.errors import InputError
from contactsim.publish import bundle
from contactsim.publish.job_list import list_jobs
from contactsim.seals import Seal, seal_path
from contactsim.study.execute import RunFiles, run
from support.crate_check import find_issues
from support.places import ROOT
from support.project import CYLINDER, Project, figure
from support.small_studies import PROJECT, SMALL, small

LIMITS = (0.0, 0.5, 1.0)
ALWAYS = PROJECT[: PROJECT.index("examples/reanalyse.py")]
"""Files of a project that every bundle holds."""


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """Where the files of a bundle lie, by their place in it: two datasets as studies make them, the rest stand-ins."""
    folder = tmp_path_factory.mktemp("results")
    for chapter, studies in SMALL.items():
        for name in studies:
            study, listed = small(chapter, name), []
            for one in study.runs():
                path, cost = (str(folder / f"runs/{one.stem}.{ending}") for ending in ("nc", "json"))
                run(one.settings, one.source, RunFiles(path, cost))
                place = {"coordinates": one.coordinates, "member": one.member, "measures_error": False, "error": "grid"}
                listed.append({"path": path, "costs": cost} | place)
            made = aggregate.aggregate(listed, study.settings | {"name": name, "tier": "small"}, "abc")
            dataset.write(made, folder / f"datasets/{chapter}_{name}.nc")
            (folder / "costs").mkdir(exist_ok=True)
            costs.table(listed).to_csv(folder / f"costs/{chapter}_{name}.csv", index=False)
    for name in ("figures/fig_3_2.png", "figures/fig_3_2.csv", "figures/cover.gif", "claims/ch3.pdf", "report.html"):
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(name, encoding="utf-8")
    shown = (file for file in folder.rglob("*") if file.is_file() and "runs" not in file.parts)
    return {str(file.relative_to(folder)): file for file in shown} | {name: ROOT / name for name in PROJECT}


@pytest.fixture(scope="module")
def plan(results):
    """What a bundle of these is told."""
    data = {Path(place).stem: f"digest of {place}" for place in results if place.endswith(".nc")}
    return {"tier": "small", "titles": {"fig_3_2": "Area | <i>pressure", "ch3_rough_line": "Lines"}, "data": data}


@pytest.fixture(scope="module")
def jobs(tmp_path_factory):
    """The jobs behind a figure: one simulates, one gathers, one draws; another figure is of no concern."""
    folder = tmp_path_factory.mktemp("sealed")
    chain = ["runs/rough_line/0.nc", "datasets/ch3_rough_line.nc", "figures/fig_3_2.png"]
    for number, (place, *inputs) in enumerate([chain[:1], chain[1::-1], chain[:0:-1], ["figures/other.png"]]):
        Seal(f"rule_{number}", {}, "settings", dict.fromkeys(inputs, "sum"), {place: f"sum of {place}"}).write(folder)
        os.utime(seal_path(folder, place), (1e9 + 60 * number,) * 2)
    return list_jobs(folder, ["figures/fig_3_2.png", "LICENSE"])


def test_the_list_of_jobs_goes_back_to_the_first(jobs):
    assert jobs.rule.tolist() == ["rule_1", "rule_2", "rule_0"]
    assert jobs.result.tolist() == ["datasets/ch3_rough_line.nc", "figures/fig_3_2.png", "runs/rough_line/0.nc"]
    assert jobs.inputs.tolist() == ["runs/rough_line/0.nc", "datasets/ch3_rough_line.nc", ""]
    assert jobs.sha256.tolist() == [f"sum of {place}" for place in jobs.result]
    assert jobs.ended.tolist() == [f"2001-09-09T01:{minute}:40+00:00" for minute in (47, 48, 46)]


@pytest.fixture(scope="module")
def made(plan, results, jobs, tmp_path_factory):
    """A bundle; tests leave it as it is."""
    target = tmp_path_factory.mktemp("made") / "bundle"
    bundle.write_bundle(plan, results, jobs, target)
    return target


def contents(folder):
    return {str(file.relative_to(folder)): file.read_bytes() for file in folder.rglob("*") if file.is_file()}


def damaged(folder):
    """The files whose sum is not as it is written, and those that have none."""
    lines = (folder / "SHA256SUMS").read_text(encoding="utf-8").splitlines()
    sums = {place: value for value, place in (line.split("  ", 1) for line in lines)}
    found = {place: hashlib.sha256(content).hexdigest() for place, content in contents(folder).items()}
    return {place for place in sums.keys() | found.keys() - {"SHA256SUMS"} if sums.get(place) != found.get(place)}


def test_a_bundle_holds_all_files_as_they_are_and_four_of_its_own(made, results, jobs):
    found = contents(made)
    assert found.keys() - results.keys() == {"README.md", "SHA256SUMS", "jobs.csv", "ro-crate-metadata.json"}
    pd.testing.assert_frame_equal(pd.read_csv(made / "jobs.csv", keep_default_na=False), jobs)
    assert all(found[place] == path.read_bytes() for place, path in results.items())


@pytest.mark.parametrize("place", ["datasets/ch3_rough_line.nc", "README.md", "ro-crate-metadata.json"])
def test_the_sums_hold_until_a_byte_is_flipped(made, place, tmp_path):
    copy = shutil.copytree(made, tmp_path / "copy")
    assert damaged(copy) == set()
    content = bytearray((copy / place).read_bytes())
    content[len(content) // 2] ^= 1
    (copy / place).write_bytes(content)
    assert damaged(copy) == {place}


@pytest.mark.skipif(not shutil.which("sha256sum"), reason="needs sha256sum")
def test_the_command_of_the_readme_checks_the_sums(made, tmp_path):
    copy = shutil.copytree(made, tmp_path / "copy")
    (command,) = re.findall(r"`(sha256sum [^`]+)`", (copy / "README.md").read_text(encoding="utf-8"))
    assert subprocess.run(command.split(), cwd=copy, check=True, capture_output=True).stdout == b""
    (copy / "LICENSE").write_text("other", encoding="utf-8")
    told = subprocess.run(command.split(), cwd=copy, check=False, capture_output=True, text=True)
    assert told.returncode != 0
    assert told.stdout == "LICENSE: FAILED\n"


def test_two_bundles_of_the_same_results_are_the_same_byte_for_byte(made, plan, results, jobs, tmp_path):
    moved = {}
    for place, path in reversed(results.items()):
        moved[place] = tmp_path / "moved" / place
        moved[place].parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(path, moved[place])
    bundle.write_bundle(plan, moved, jobs, tmp_path / "other")
    assert contents(tmp_path / "other") == contents(made)


def test_the_readme_names_every_file_dimension_and_variable_with_its_unit_and_meaning(made):
    text = (made / "README.md").read_text(encoding="utf-8")
    for place in contents(made):
        assert f"| `{place}` |" in text, place
    for path in (made / "datasets").iterdir():
        data = xr.load_dataset(path)
        section = text[text.index(f"### `datasets/{path.name}`") :].split("\n## ")[0].split("\n### ")[0]
        assert data.attrs["title"] in section
        assert f"digest of datasets/{path.name}" in section
        for name, count in data.sizes.items():
            assert f"{name} {count}" in section
            assert f"| `{name}` | " in text.partition("## Dimensions")[2].partition("## Variables")[0]
        for name, item in data.variables.items():
            row = next(line for line in section.splitlines() if f"`{name}`" in line)
            assert row.startswith(f"| {', '.join(map(str, item.dims)) or '–'} |")
            assert f"| `{name}` | {item.attrs['units']} | {item.attrs['long_name']}" in text
    assert "| `status` | 1 | status of the solution: 0 converged, 1 max_iterations," in text
    assert "| `figures/fig_3_2.png` | Area \\| &lt;i>pressure (figure; csv:" in text


def test_the_metadata_list_every_file_that_is_there_and_no_other(made):
    graph = json.loads((made / "ro-crate-metadata.json").read_text(encoding="utf-8"))["@graph"]
    entities = {one["@id"]: one for one in graph}
    assert len(entities) == len(graph)
    files = {one["@id"] for one in graph if "File" in one["@type"]}
    assert files == contents(made).keys() - {"ro-crate-metadata.json"}
    assert {part["@id"] for part in entities["./"]["hasPart"]} == files
    for place in files - {"SHA256SUMS"}:
        assert entities[place]["sha256"] == hashlib.sha256((made / place).read_bytes()).hexdigest()
        assert entities[place]["description"]
        assert int(entities[place]["contentSize"]) == (made / place).stat().st_size
    measured = entities["datasets/ch3_rough_line.nc"]["variableMeasured"]
    assert set(measured) == set(xr.load_dataset(made / "datasets/ch3_rough_line.nc").variables)


def test_the_metadata_say_what_an_archive_asks_for_as_the_citation_does(made):
    crate = ROCrate(made)
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert crate.version == "1.1"
    root = crate.root_dataset
    assert root["name"].startswith(citation["title"])
    assert root["datePublished"] == citation["date-released"]
    assert [root["author"]["name"]] == [author["name"] for author in citation["authors"]]
    assert root["license"].id == f"https://spdx.org/licenses/{citation['license']}"
    assert root["description"]


def test_the_metadata_tell_the_run_that_made_the_results(made, results):
    crate = ROCrate(made)
    workflow, action = crate.mainEntity, crate.root_dataset["mentions"]
    assert workflow.id == "Snakefile"
    assert {"File", "SoftwareSourceCode", "ComputationalWorkflow"} == set(workflow.type)
    assert workflow["programmingLanguage"]["name"] == "Snakemake"
    assert workflow["license"] == action["instrument"]["license"] == crate.root_dataset["license"]
    assert [profile["name"] for profile in crate.root_dataset["conformsTo"]] == list(bundle.PROFILES.values())
    assert action["instrument"] == workflow
    assert (action["startTime"], action["endTime"]) == ("2001-09-09T01:46:40+00:00", "2001-09-09T01:48:40+00:00")
    assert action["agent"] == crate.root_dataset["author"]
    tier, *settings = action["object"]
    assert (tier["name"], tier["value"]) == ("tier", "small")
    assert [file.id for file in settings] == ["config/ch3.yaml"]
    created = {file.id for file in action["result"]}
    folders = ("datasets/", "costs/", "figures/", "claims/", "report.html")
    assert created == {place for place in results if place.startswith(folders)}
    assert crate.get("jobs.csv")["about"] == action


UNKNOWN = {
    "The Application SHOULD have a url": "the citation names no address of the source",
    "The organization SHOULD have a URL.": "nor one of the authors",
    "The `publisher` property of a `Root Data Entity` SHOULD be an `Organization`": "an archive is the publisher",
    "The Main Workflow SHOULD comply with Bioschemas ComputationalWorkflow profile version 1.0 or later": "needs both",
    "The SoftwareApplication id SHOULD be an absolute URI": "it is a file; the check is about the names of types",
}
"""What the profiles recommend and the metadata lack, with the reason."""


@pytest.mark.filterwarnings("default")  # of the validator's own libraries
def test_a_validator_finds_all_that_the_profile_requires(made, tmp_path):
    pytest.importorskip("rocrate_validator")
    issues = find_issues(made, "workflow-run-crate", tmp_path / "cache")
    assert set(issues) == {"OPTIONAL", "RECOMMENDED"}
    assert issues["RECOMMENDED"] == set(UNKNOWN)


@pytest.mark.filterwarnings("default")
def test_the_validator_would_tell_a_run_without_its_workflow(made, tmp_path):
    pytest.importorskip("rocrate_validator")
    copy = shutil.copytree(made, tmp_path / "copy")
    crate = ROCrate(copy)
    del crate.root_dataset["mentions"]["instrument"]
    crate.metadata.write(copy)
    issues = find_issues(copy, "workflow-run-crate", tmp_path / "cache")
    assert "The Action MUST have an instrument property that references the executed tool" in issues["REQUIRED"]


def without_date(path):
    path.write_text(re.sub("date-released.*\n", "", path.read_text(encoding="utf-8")), encoding="utf-8")


def cut_short(path):
    path.write_bytes(path.read_bytes()[:1000])


@pytest.mark.parametrize(
    ("place", "spoil", "key"),
    [
        ("figures/cover.gif", Path.unlink, "bundle"),
        ("datasets/ch3_rough_line.nc", cut_short, "dataset"),
        ("CITATION.cff", without_date, "date-released"),
    ],
)
def test_what_is_missing_or_damaged_is_named_and_leaves_no_half_bundle(
    plan, results, jobs, place, spoil, key, tmp_path
):
    spoiled = tmp_path / "spoiled" / Path(place).name
    spoiled.parent.mkdir()
    shutil.copyfile(results[place], spoiled)
    spoil(spoiled)
    older = tmp_path / "bundle"
    older.mkdir()
    (older / "LICENSE").touch()
    with pytest.raises(InputError) as refused:
        bundle.write_bundle(plan, results | {place: spoiled}, jobs, older)
    assert refused.value.key == key
    assert Path(place).name in str(refused.value)
    assert [file.name for file in tmp_path.iterdir()] == ["spoiled"]


def test_a_bundle_takes_the_place_of_an_older_one_and_of_what_a_kill_left(made, plan, results, jobs, tmp_path):
    for name in ("bundle", ".bundle.tmp"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "stale.txt").touch()
    bundle.write_bundle(plan, results, jobs, tmp_path / "bundle")
    assert contents(tmp_path) == {f"bundle/{place}": content for place, content in contents(made).items()}


def test_a_person_is_cited_as_one():
    assert bundle.author_name({"given-names": "M.", "family-names": "Müser"}) == "M. Müser"


@pytest.fixture(scope="module")
def told(made):
    """What the example prints when it is run in the bundle, as its README says."""
    (command,) = re.findall(r"`python ([^`]+)`", (made / "README.md").read_text(encoding="utf-8"))
    done = subprocess.run([sys.executable, *command.split()], cwd=made, check=True, capture_output=True, text=True)
    assert done.stderr == ""
    return [[float(number) for number in re.findall(r"[-\d.]+", line)] for line in done.stdout.splitlines()]


def with_error(values):
    """Mean and standard error of values of members."""
    return [np.mean(values), np.std(values, ddof=1) / np.sqrt(len(values))]


def test_the_example_counts_contact_as_the_gaps_themselves_do(made, told):
    data = xr.load_dataset(made / "datasets/ch5_rough_adhesive.nc")
    assert (data.status == 0).all()
    rows = [row for row in told if len(row) == 8]
    assert len(rows) == data.work_of_separation.size * data.snapshot.size
    for work, approach, *found in rows:
        gaps = data.normal_gap.sel(work_of_separation=work, snapshot=approach).values
        expected = [number for limit in LIMITS for number in with_error((gaps < limit).mean(axis=1))]
        assert found == pytest.approx(expected, abs=1e-5)
        assert found[4] > 0


def test_the_example_fits_the_law_that_another_fit_finds(made, told, results):
    data = xr.load_dataset(made / "datasets/ch3_rough_line.nc").sel(reduced_pressure=[0.01, 0.03, 0.1])
    rows = [row for row in told if len(row) == 5]
    assert [row[0] for row in rows] == [0.2, 0.8]
    for hurst_exponent, *found in rows:
        areas = data.contact_points.sel(hurst_exponent=hurst_exponent).values / data.points.item()
        lines = [linregress(np.log(data.reduced_pressure), np.log(area)) for area in areas]
        slopes, factors = [line.slope for line in lines], [np.exp(line.intercept) for line in lines]
        assert found == pytest.approx(with_error(slopes) + with_error(factors), abs=1e-5)
        assert found[0] == pytest.approx(1.0, abs=0.2)


def test_the_example_needs_no_solver():
    tree = ast.parse((ROOT / "examples/reanalyse.py").read_text(encoding="utf-8"))
    imports = [node for node in ast.walk(tree) if isinstance(node, ast.Import | ast.ImportFrom)]
    named = {alias.name for node in imports if isinstance(node, ast.Import) for alias in node.names}
    named |= {node.module for node in imports if isinstance(node, ast.ImportFrom)}
    assert named == {"__future__", "argparse", "pathlib", "numpy", "xarray"}


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    """A project of one study and one figure, with all that a bundle needs of a project."""
    project = Project.new(tmp_path_factory.mktemp("bundled") / "project")
    (project.folder / "config/ch8.yaml").unlink()
    small = {"studies": {"smooth": CYLINDER}, "figures": {"fig_9_1": figure("smooth")}}
    project.configure("ch9", small)
    for name in ALWAYS:
        shutil.copyfile(ROOT / name, project.folder / name)
    report = project.folder / "results/standard/report.html"
    report.parent.mkdir(parents=True)
    report.write_text("A report", encoding="utf-8")
    return project


@pytest.mark.slow
def test_the_workflow_makes_a_bundle_and_makes_it_again_when_what_it_holds_has_changed(project):
    made = project.make("bundle")
    assert "bundle: results/standard/bundle" in made
    folder = project.folder / "results/standard/bundle"
    assert damaged(folder) == set()
    found = set(contents(folder))
    assert found >= {"datasets/ch9_smooth.nc", "costs/ch9_smooth.csv", "figures/fig_9_1.pdf", "report.html"}
    assert found >= {"config/ch9.yaml", "config/tiers.yaml", "workflow/rules/report.smk", *ALWAYS}
    assert "examples/reanalyse.py" not in found  # it is about studies that are not here
    assert "reanalyse" not in (folder / "README.md").read_text(encoding="utf-8")
    rules = pd.read_csv(folder / "jobs.csv").rule
    assert {"simulate_member", "aggregate_study", "fig_9_1"} <= set(rules)
    assert project.planned("bundle") == []
    project.edit("publish/bundle")
    assert project.planned("bundle") == ["bundle: results/standard/bundle"]
