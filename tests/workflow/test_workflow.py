"""The workflow: an edit reruns what it changes and nothing else, and a kill or a failure loses and falsifies nothing.

Every test works on a small project of its own: this repository's Snakefile, rules, profile and package, with three
studies of one to six runs, two chapters of figures and its own config. One such project is made once, and copied.
Pauses and failures are put into jobs from outside, through a `sitecustomize` module that reads an environment variable.
"""

from __future__ import annotations

import contextlib
import re
import shutil
import zlib
from collections import Counter
from collections.abc import Callable
from copy import deepcopy
from pathlib import Path

import netCDF4
import pandas as pd
import pytest
import xarray as xr
import yaml

from support.project import (
    CONFIG,
    REPORT,
    Pause,
    Project,
    apart,
    figure,
    of_study,
    runs,
)

pytestmark = pytest.mark.slow


ROUGH_RUNS = 2 * 2 + 2 * 1  # Hurst exponents × members, and the same of the coarse grid
LONGER = {
    ("ch8", "studies.rough.load.reduced_pressure"): [0.01, 0.03, 0.1, 0.5, 1.0],
    ("ch9", "studies.smooth.load.contact_ratio"): [0.1, 0.15, 0.2, 0.25, 0.3],
}


def lengthen(project: Project) -> Project:
    """Add loads to the studies rough and smooth, between the old ones and beyond."""
    for (chapter, path), value in LONGER.items():
        project.change(chapter, path, value)
    return project


@pytest.fixture(scope="module")
def unmade(tmp_path_factory: pytest.TempPathFactory) -> Project:
    """The project with nothing made; all others are copies of it, whatever happens to the repository meanwhile."""
    return Project.new(tmp_path_factory.mktemp("unmade") / "project")


@pytest.fixture(scope="module")
def made(unmade: Project, tmp_path_factory: pytest.TempPathFactory) -> Project:
    """The project with everything made; tests leave it as it is."""
    project = unmade.copied(tmp_path_factory.mktemp("made") / "project")
    project.make("all")
    return project


@pytest.fixture(scope="module")
def longer(unmade: Project, tmp_path_factory: pytest.TempPathFactory) -> Project:
    """Another project, made at once with the longer lists of loads and never disturbed; without figures."""
    project = lengthen(unmade.copied(tmp_path_factory.mktemp("longer") / "project"))
    project.make("rough", "smooth")
    return project


@pytest.fixture
def project(made: Project, tmp_path: Path) -> Project:
    """A copy of the made project to work on."""
    return made.copied(tmp_path / "project")


@pytest.fixture
def fresh(unmade: Project, tmp_path: Path) -> Project:
    """A project in which nothing is made."""
    return unmade.copied(tmp_path / "project")


def test_the_report_is_made_with_all_else_and_follows_every_edit(project: Project) -> None:
    assert REPORT not in project.snakemake("-n", "all").stdout
    project.change("ch9", "figures.fig_9_1.title", "Another title")
    assert f"{REPORT}results/standard/report.html" in project.snakemake("-n", "all").stdout
    assert REPORT not in project.snakemake("-n", "fig_9_1").stdout


def test_a_study_is_one_job_for_each_variant_and_member(fresh: Project) -> None:
    planned = fresh.planned("all")
    assert len(set(planned)) == len(planned)
    assert of_study(planned) == {"rough": ROUGH_RUNS, "baseline": 1, "smooth": 1}
    rough = [message for message in runs(planned) if message.startswith("rough")]
    assert Counter(re.search(r"member \d+", message)[0] for message in rough) == {"member 0": 4, "member 1": 2}
    datasets = {f"dataset of {study}" for study in ("rough", "baseline", "smooth")}
    assert apart(planned) == datasets | {"fig_8_1", "fig_8_2", "fig_8_3", "fig_9_1"}


def test_a_figure_needs_its_own_study_only(fresh: Project) -> None:
    planned = fresh.planned("fig_9_1")
    assert of_study(planned) == {"smooth": 1}
    assert apart(planned) == {"dataset of smooth", "fig_9_1"}


def test_a_cluster_is_asked_for_the_same_jobs(fresh: Project) -> None:
    assert fresh.planned("all", options=("--workflow-profile", "profiles/slurm")) == fresh.planned("all")


def test_nothing_is_planned_when_nothing_has_changed(made: Project) -> None:
    assert made.planned("all", "rough", "baseline", "smooth") == []


def test_the_order_of_keys_and_of_loads_does_not_matter(project: Project) -> None:
    def reversed_keys(section: object) -> object:
        if not isinstance(section, dict):
            return section
        return {key: reversed_keys(section[key]) for key in reversed(section)}

    for name in ("ch8", "ch9", "config"):
        file = project.folder / f"config/{name}.yaml"
        before = file.read_text(encoding="utf-8")
        content = reversed_keys(yaml.safe_load(before))
        if name == "ch8":
            content["studies"]["rough"]["load"]["reduced_pressure"] = [0.5, 0.01, 0.1]
        project.configure(name, content, ordered=False)
        assert file.read_text(encoding="utf-8") != before
    assert project.planned("all") == []


def test_an_added_load_is_computed_alone_and_gives_the_files_of_the_longer_list(
    project: Project, longer: Project, made: Project
) -> None:
    lengthen(project)
    planned = project.planned("fig_8_1")
    assert of_study(planned) == {"rough": ROUGH_RUNS}
    assert apart(planned) == {"dataset of rough", "fig_8_1"}
    project.make("rough")
    assert project.steps("rough") == {(3, 2)}
    assert longer.steps("rough") == {(0, 5)}
    assert project.science("rough") == longer.science("rough")
    assert set(project.science("rough").items()).isdisjoint(made.science("rough").items())
    assert project.planned("rough") == []


def test_a_load_taken_away_needs_no_solution(project: Project) -> None:
    project.change("ch9", "studies.smooth.load.contact_ratio", [0.1, 0.3])
    project.make(*project.run_targets("smooth"))
    assert project.steps("smooth") == {(2, 0)}


@pytest.mark.parametrize("damaged", [False, True], ids=["sound", "damaged"])
def test_a_study_takes_the_loads_that_another_holds_unless_they_were_changed(
    project: Project, longer: Project, damaged: bool
) -> None:
    study = deepcopy(CONFIG["ch8"]["studies"]["rough"]) | {"same_surfaces_as": "rough"}
    study["load"]["reduced_pressure"] = LONGER["ch8", "studies.rough.load.reduced_pressure"]
    project.change("ch8", "studies.more", study)
    assert of_study(project.planned("more")) == {"more": ROUGH_RUNS}
    for path in (project.folder / "results/standard/runs/rough").rglob("*.nc") if damaged else ():
        with netCDF4.Dataset(path, "a") as file:
            file["relative_contact_area"][:] = 0.5
    project.make("more")
    assert project.steps("more") == ({(0, 5)} if damaged else {(3, 2)})
    runs_made, at_once = (
        one.files(f"standard/runs/{name}/*/*.nc") for one, name in ((project, "more"), (longer, "rough"))
    )
    assert list(runs_made.values()) == list(at_once.values())


def test_added_members_are_run_and_the_others_left_alone(project: Project) -> None:
    before = project.times("standard/runs/rough/*/*"), project.files("standard/runs/rough/*/*")
    project.change("ch8", "studies.rough.members", 3)
    planned = project.planned("all")
    assert of_study(planned) == {"rough": 2}
    assert all("member 2" in message for message in runs(planned))
    assert apart(planned) == {"dataset of rough", "fig_8_1", "fig_8_2"}
    project.make("rough")
    after = project.times("standard/runs/rough/*/*"), project.files("standard/runs/rough/*/*")
    assert {name: after[0][name] for name in before[0]} == before[0]
    assert {name: after[1][name] for name in before[1]} == before[1]
    data = xr.load_dataset(project.folder / "results/standard/datasets/ch8_rough.nc")
    assert data.member.values.tolist() == [0, 1, 2]


def test_points_made_by_other_code_are_not_taken_over(project: Project) -> None:
    lengthen(project)
    project.edit(
        "solvers/hard_wall/active_set", 'import logging; logging.getLogger(__name__).info("this copy, edited")'
    )
    project.make(*project.run_targets("smooth"))
    assert project.steps("smooth") == {(0, 5)}
    assert all("this copy, edited" in text for text in project.logs("smooth").values())


def test_points_made_from_another_setting_are_not_taken_over(project: Project) -> None:
    lengthen(project)
    project.change("ch9", "studies.smooth.tolerance", 1.0e-4)
    project.make(*project.run_targets("smooth"))
    assert project.steps("smooth") == {(0, 5)}


def test_a_figures_style_redraws_that_figure_alone(project: Project) -> None:
    project.change("ch8", "figures.fig_8_1.size", [3.5, 2.0])
    assert project.planned("all") == ["fig_8_1"]
    project.change("ch9", "figures.fig_9_1.title", "Another title")
    assert project.planned("all") == ["fig_8_1", "fig_9_1"]


def test_a_chapters_drawing_code_redraws_its_figures_alone(project: Project) -> None:
    project.edit("figures/ch8")
    assert project.planned("all") == ["fig_8_1", "fig_8_2", "fig_8_3"]


def test_a_solvers_code_reruns_the_studies_that_use_it_alone(made: Project, tmp_path: Path) -> None:
    baseline, others = (made.copied(tmp_path / name) for name in ("baseline", "others"))
    baseline.edit("solvers/hard_wall/polonsky_keer")
    planned = baseline.planned("all")
    assert of_study(planned) == {"baseline": 1}
    assert apart(planned) == {"dataset of baseline", "fig_8_3"}
    others.edit("solvers/hard_wall/active_set")
    planned = others.planned("all")
    assert of_study(planned) == {"rough": ROUGH_RUNS, "smooth": 1}
    assert apart(planned) == {"dataset of rough", "dataset of smooth", "fig_8_1", "fig_8_2", "fig_9_1"}


def test_aggregation_code_and_titles_run_nothing_again(project: Project) -> None:
    project.change("ch9", "studies.smooth.title", "Another title")
    assert project.planned("all") == ["dataset of smooth", "fig_9_1"]
    project.edit("analysis/aggregate")
    planned = project.planned("all")
    assert runs(planned) == []
    assert {f"dataset of {study}" for study in ("rough", "baseline", "smooth")} < set(planned)


def test_lost_files_are_made_again_as_they_were(project: Project, made: Project) -> None:
    for name in project.science("smooth"):
        (project.folder / name).unlink()
    made_again = project.make("smooth")
    assert of_study(made_again) == {"smooth": 1}
    assert apart(made_again) == {"dataset of smooth"}
    assert project.science("smooth") == made.science("smooth")


def test_a_second_project_makes_the_same_files_byte_for_byte(fresh: Project, made: Project) -> None:
    fresh.make("rough")
    assert fresh.steps("rough") == made.steps("rough") == {(0, 3)}
    assert fresh.science("rough") == made.science("rough")


KILLS = {"job": Pause.kill_job, "snakemake": Pause.kill_all}


@pytest.mark.parametrize("kill", KILLS)
def test_a_kill_midway_leaves_nothing_that_the_same_command_does_not_finish(
    fresh: Project, made: Project, kill: str
) -> None:
    with fresh.paused("step 2/3", "--", "smooth") as pause:
        KILLS[kill](pause)
    assert fresh.files("standard/runs/**/*.nc", "standard/datasets/*") == {}
    fresh.make("smooth")
    assert fresh.steps("smooth") == {(0, 3)}
    assert fresh.science("smooth") == made.science("smooth")


@pytest.mark.parametrize(
    ("kill", "moment"),
    [
        ("snakemake", "step 4/5"),  # midway
        ("job", r"replaced .*/0\.json"),  # all written, but for the sign that it is
        ("snakemake", r"replaced .*/0\.nc"),  # new data beside old costs
    ],
)
def test_a_kill_while_loads_are_added_keeps_the_old_points(
    project: Project, longer: Project, kill: str, moment: str
) -> None:
    lengthen(project)
    with project.paused(moment, "--", "smooth") as pause:
        KILLS[kill](pause)
    made_after = project.make("smooth")
    assert of_study(made_after) == {"smooth": 1}
    assert apart(made_after) == {"dataset of smooth"}
    ((taken, computed),) = project.steps("smooth")
    assert taken >= 3
    assert taken + computed == 5
    assert project.science("smooth") == longer.science("smooth")
    assert project.planned("smooth") == []


def test_a_run_that_failed_is_not_taken_for_done(project: Project, longer: Project) -> None:
    lengthen(project)
    failed = project.snakemake("--", "smooth", CONTACTSIM_TEST_AT="step 4/5")
    assert failed.returncode != 0
    assert "made to fail" in failed.stderr
    made_after = project.make("smooth")
    assert of_study(made_after) == {"smooth": 1}
    assert apart(made_after) == {"dataset of smooth"}
    assert project.steps("smooth") == {(3, 2)}
    assert project.science("smooth") == longer.science("smooth")


def cut(content: bytes) -> bytes:
    """The first half."""
    return content[: len(content) // 2]


def garbled(content: bytes) -> bytes:
    """All but the first kilobyte overwritten."""
    return content[:1024] + b"\x5a" * (len(content) - 1024)


def worn(content: bytes) -> bytes:
    """One byte changed in the middle of the longest compressed block: the file still opens."""
    blocks = {}
    for found in re.finditer(b"\x78\x01|\x78\x5e", content):
        stream = zlib.decompressobj()
        with contextlib.suppress(zlib.error):
            stream.decompress(content[found.start() :])
        if stream.eof:
            blocks[found.start()] = len(content) - found.start() - len(stream.unused_data)
    start = max(blocks, key=blocks.get)
    place = start + blocks[start] // 2
    return content[:place] + bytes([content[place] ^ 0xFF]) + content[place + 1 :]


def turned(content: bytes) -> bytes:
    """One bit changed in the middle."""
    place = len(content) // 2
    return content[:place] + bytes([content[place] ^ 1]) + content[place + 1 :]


def emptied(content: bytes) -> bytes:
    """Nothing."""
    return content[:0]


@pytest.mark.parametrize("damage", [cut, garbled, worn, emptied])
def test_a_damaged_old_file_is_computed_anew(
    project: Project, longer: Project, damage: Callable[[bytes], bytes]
) -> None:
    lengthen(project)
    (file,) = project.folder.glob("results/standard/runs/smooth/*/0.nc")
    file.write_bytes(damage(file.read_bytes()))
    project.make(*project.run_targets("smooth"))
    assert project.steps("smooth") == {(0, 5)}
    assert file.with_name("0.nc.aside").exists()
    assert project.files("standard/runs/smooth/*/*.nc") == longer.files("standard/runs/smooth/*/*.nc")


RESULTS = ("standard/runs/*/*/*.nc", "standard/datasets/*.nc", "standard/figures/*.csv")


def test_whatever_happens_to_results_they_are_made_again_as_they_were(project: Project, made: Project) -> None:
    folder = project.folder / "results/standard"
    runs_of_rough = sorted(folder.glob("runs/rough/*/0.nc"))
    damaged = [runs_of_rough[0], folder / "datasets/ch8_rough.nc", folder / "figures/fig_9_1.csv"]
    runs_of_rough[0].write_bytes(runs_of_rough[1].read_bytes())  # a run of another exponent
    damaged[1].write_bytes(turned(damaged[1].read_bytes()))
    damaged[2].write_bytes(b"")
    shutil.rmtree(folder / "runs/baseline")  # gone after its dataset was made
    (folder / "figures/fig_8_2.png").unlink()
    dry = project.snakemake("-n", "--", "all")
    for path in damaged:
        told = (
            f"{path.relative_to(project.folder)}: was changed since it was made. It is set aside as {path.name}.aside"
        )
        assert told in dry.stderr
        assert path.exists()
    assert "runs/baseline" in dry.stderr
    planned = project.planned("all")
    made_again = project.make("all")
    assert sorted(planned) == sorted(made_again)
    assert of_study(made_again) == {"rough": 1, "baseline": 1}
    assert {"fig_8_1", "fig_8_2", "fig_8_3", "fig_9_1"} <= apart(made_again)
    for path in damaged:
        path.with_name(f"{path.name}.aside").unlink()
    assert project.files(*RESULTS) == made.files(*RESULTS)
    assert project.planned("all") == []


def test_results_of_another_tier_or_project_are_not_taken_for_those_of_this_one(fresh: Project, made: Project) -> None:
    standard, other = fresh.folder / "results/standard", made.folder / "results/standard"
    shutil.copytree(other / "figures", standard / "figures")
    done = fresh.snakemake("--", "fig_9_1")
    assert done.returncode == 0
    assert "fig_9_1.csv: has no seal, so it was not made here" in done.stderr
    assert fresh.steps("smooth") == {(0, 3)}
    assert fresh.files("standard/figures/fig_9_1.csv") == made.files("standard/figures/fig_9_1.csv")


def test_an_edit_is_seen_though_all_that_snakemake_remembers_is_lost(project: Project) -> None:
    shutil.rmtree(project.folder / ".snakemake")
    assert project.planned("all") == []
    project.edit("solvers/hard_wall/polonsky_keer")
    made_again = project.make("all")
    assert of_study(made_again) == {"baseline": 1}
    assert {"dataset of baseline", "fig_8_3"} <= apart(made_again)


def test_an_edit_is_seen_though_snakemake_was_told_that_all_is_up_to_date(project: Project) -> None:
    project.change("ch9", "figures.fig_9_1.title", "Another title")
    assert project.snakemake("--touch", "--", "all").returncode == 0
    assert project.planned("all") == ["fig_9_1"]
    project.make("all")
    assert project.planned("all") == []


def test_two_at_once_in_one_folder_are_refused_but_a_dry_run_is_not(fresh: Project, made: Project) -> None:
    with fresh.paused("step 2/3", "--", "smooth") as first:
        second = fresh.snakemake("--", "smooth")
        assert second.returncode != 0
        errors = [line for line in second.stderr.splitlines() if not line.startswith("Using ")]
        assert errors == ["Error: another snakemake is at work in this folder; wait for it or stop it"]
        assert of_study(fresh.planned("baseline")) == {"baseline": 1}
        assert first.go_on() == 0
    assert fresh.science("smooth") == made.science("smooth")


def test_tiers_have_separate_results(project: Project) -> None:
    quick = ("--config", "tier=quick")
    before = project.times("standard/**/*")
    assert of_study(project.make("smooth", options=quick)) == {"smooth": 1}
    assert project.planned("smooth", options=quick) == []
    assert project.planned("all") == []
    assert project.times("standard/**/*") == before
    for tier, points in (("quick", 256), ("standard", 8192)):
        data = xr.load_dataset(project.folder / f"results/{tier}/datasets/ch9_smooth.nc")
        assert data.points.item() == points


def test_no_target_lists_the_targets_with_a_line_each(fresh: Project) -> None:
    shown = fresh.snakemake()
    assert shown.returncode == 0
    lines = [line.strip() for line in shown.stdout.splitlines()]
    for name in ("fig_8_1", "fig_8_2", "fig_8_3", "fig_9_1", "rough", "baseline", "smooth", "all"):
        assert sum(line.startswith(f"{name} ") for line in lines) == 1, name
    assert "Figure of baseline" in shown.stdout
    assert not (fresh.folder / "results").exists()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--", "fig_9_9"), ("no target 'fig_9_9'", "fig_8_1", "fig_9_1", "smooth")),
        (("--", "fig_9.1"), ("no target 'fig_9.1'; did you mean fig_9_1?",)),
        (("--", "fig_9_1", "TIER=quick"), ("'TIER=quick' is no target", "--config tier=quick")),
        (("--config", "tier=nonsense", "--", "all"), ("config/tiers.yaml", "tier", "'nonsense'", "quick, standard")),
        (("--config", "other=1", "--", "all"), ("--config", "'other'", "tier=NAME")),
    ],
)
def test_a_wrong_command_is_refused_in_words(
    fresh: Project, arguments: tuple[str, ...], words: tuple[str, ...]
) -> None:
    refused = fresh.snakemake(*arguments)
    assert refused.returncode != 0
    for word in words:
        assert word in refused.stderr
    assert refused.stderr.count("Error") == 1
    assert "Traceback" not in refused.stderr
    assert not (fresh.folder / "results").exists()


def test_work_precision_studies_are_made_case_by_case_and_leave_their_study_alone(project: Project) -> None:
    case = figure("smooth") | {
        "load": [0.1, 0.3],
        "quantities": ["relative_contact_area"],
        "settled": {"points": 512, "tolerance": 1.0e-3},
        "reference": {"points": 4096, "tolerance": 1.0e-6},
        "levels": {"points": [0.05]},
        "solvers": {"active_set": {"points": [256, 512], "tolerance": [0.1]}},
    }
    tiers = ("standard", "quick")
    project.configure("accuracy", {tier: {"wave": case, "other": case} for tier in tiers})
    before = project.times("standard/runs/**/*")
    jobs = ["accuracy of wave: active_set", "accuracy of wave: reference"]
    picture = "accuracy_wave: results/standard/figures/accuracy_wave.png"
    assert project.make("accuracy_wave") == [*jobs, picture]
    assert project.times("standard/runs/**/*") == before
    prices = pd.read_csv(project.folder / "results/standard/figures/accuracy_wave.csv")
    assert prices.points.tolist() == [256, 512, 512] and (prices.seconds > 0).all()
    assert (prices.relative_contact_area[prices.knob == "points"].between(1e-3, 0.05)).all()
    case["solvers"]["active_set"]["tolerance"] = [0.01]
    project.configure("accuracy", {tier: {"wave": case} for tier in tiers})
    assert project.planned("accuracy_wave") == [jobs[0], picture]


def test_baselines_are_measured_once_and_then_taken_from_the_package(project: Project) -> None:
    case = figure("smooth") | {
        "load": [0.1, 0.3],
        "quantities": ["relative_contact_area"],
        "settled": {"points": 512, "tolerance": 1.0e-3},
        "reference": {"points": 4096, "tolerance": 1.0e-6},
        "levels": {"points": [0.05]},
        "solvers": {"active_set": {"points": [256, 512]}, "polonsky_keer": {"points": [256]}},
    }
    content = {"standard": {"wave": case}, "quick": {"wave": case}, "baselines_from_package": ["standard"]}
    project.configure("accuracy", content)
    own = ["accuracy of wave: active_set", "accuracy of wave: reference"]
    baseline, picture = "accuracy of wave: polonsky_keer", "accuracy_wave: results/standard/figures/accuracy_wave.png"
    assert project.make("accuracy_wave") == [own[0], baseline, own[1], picture]  # the package has no such case
    table = project.folder / "results/standard/figures/accuracy_wave.csv"
    measured = pd.read_csv(table)
    assert len(project.make("export_baselines")) == 1
    package = project.folder / "src/contactsim/evaluation/work_precision"
    shutil.copytree(project.folder / "results/standard/accuracy/package", package, dirs_exist_ok=True)
    assert project.make("accuracy_wave") == [picture]
    pd.testing.assert_frame_equal(pd.read_csv(table).drop(columns="seconds"), measured.drop(columns="seconds"))
    shutil.rmtree(project.folder / "results/standard/accuracy")
    table.unlink()
    assert project.planned("accuracy_wave") == [*own, picture]
    case["solvers"]["polonsky_keer"]["points"] = [512]
    project.configure("accuracy", content)
    assert project.planned("accuracy_wave") == [own[0], baseline, own[1], picture]
    refused = project.snakemake("-n", "--config", "tier=quick", "--", "export_baselines")
    assert refused.returncode != 0
    assert "got quick; allowed: one that accuracy.yaml lists in baselines_from_package" in refused.stderr


def test_a_wrong_setting_is_refused_with_file_key_value_and_what_is_allowed(fresh: Project) -> None:
    content = deepcopy(CONFIG["ch9"])
    content["studies"]["smooth"]["pionts"] = 512
    fresh.configure("ch9", content)
    refused = fresh.snakemake("-n", "--", "all")
    assert refused.returncode != 0
    for word in ("config/ch9.yaml", "studies.smooth.pionts", "512", "points"):
        assert word in refused.stderr
    assert "Traceback" not in refused.stderr
