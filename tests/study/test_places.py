"""What settings name in the file system is where it may be, or refused before anything is made."""

from __future__ import annotations

import os

import pytest

from contactsim.errors import InputError
from contactsim.study.places import check_config_files, data_file, read_results
from contactsim.study.study import Study
from support.rough_study import ROUGH

NAMES = ("config", "tiers")


@pytest.fixture
def project(tmp_path, monkeypatch):
    """A project's folder, in which the command is given."""
    home = tmp_path / "project"
    (home / "src").mkdir(parents=True)
    monkeypatch.chdir(home)
    return home


def results_refusal(text, project, tier="quick"):
    with pytest.raises(InputError) as caught:
        read_results(text, tier, project, project / "config.yaml")
    error = caught.value
    assert (error.key, error.value, error.file) == ("results", text, project / "config.yaml")
    return error


@pytest.mark.parametrize(
    "text", ["results", "a b/c", "a%20b", "résultats", "../elsewhere", "..", ".", "x-1.5_@,+=", "a/"]
)
def test_a_folder_beside_the_code_can_hold_results(project, text):
    assert str(read_results(text, "quick", project, project / "config.yaml")) == os.path.normpath(f"{text}/quick")
    assert not (project / text / "quick").exists()


@pytest.mark.parametrize(
    "text",
    [
        "",
        " ",
        "~",
        "~/x",
        "a{b}",
        "{study}",
        "a\nb",
        "a\0b",
        "a;b",
        "$(id)",
        "`id`",
        "a'b",
        'a"b',
        "a*",
        "a?",
        "[a]",
        "a:b",
        "a\\b",
    ]
    + ["<a>", "a|b", "a&b", "a#b", " a", "a ", "a/ b", "a\tb"],
)
def test_a_folder_with_signs_that_mean_something_elsewhere_is_refused(project, text):
    assert "letters, digits" in str(results_refusal(text, project))


@pytest.mark.parametrize(
    "text", ["src", "src/contactsim/x", "config", ".git", ".snakemake/x", "x/../src", "../project/docs"]
)
def test_results_among_the_code_are_refused(project, text):
    assert "none of benchmarks, config" in str(results_refusal(text, project))


def test_results_that_are_the_project_or_hold_it_are_refused(project):
    results_refusal("..", project, "project")
    results_refusal("/", project, project.parts[1])
    results_refusal(str(project), project, "src")


def test_a_folder_that_cannot_be_made_is_refused(project):
    (project / "file").write_text("x")
    (project / "gone").symlink_to(project / "nowhere")
    (project / "made").mkdir()
    (project / "made/quick").write_text("x")
    for text in ("file", "file/x", "gone", "gone/x", "made", "/dev/null", "x" * 300):
        assert "a folder that can be made and written to" in str(results_refusal(text, project))


def test_a_folder_that_cannot_be_written_to_is_refused(project, monkeypatch):
    (project / "locked").mkdir()
    monkeypatch.setattr(os, "access", lambda place, mode: place.name != "locked")  # root may write everywhere
    assert "written to" in str(results_refusal("locked", project))


@pytest.mark.parametrize("name", ["ch3 copy.yaml", "ch3.yml", "tier.yaml", "notes.yaml", "CH3.YAML", "config.yml"])
def test_settings_that_nothing_would_read_are_refused(project, name):
    (project / name).write_text("a: 1")
    with pytest.raises(InputError, match=r"ch1.yaml, ch2.yaml … for chapters, and config.yaml, tiers.yaml") as caught:
        check_config_files(project, NAMES)
    assert (caught.value.key, caught.value.value, caught.value.file) == ("file", name, project / name)


def test_files_that_are_no_settings_do_not_matter(project):
    for name in ("ch3.yaml", "ch12.yaml", "config.yaml", "README.md", "ch3.yaml~", ".#ch3.yaml", ".ch3.yaml.swp"):
        (project / name).write_text("a: 1")
    check_config_files(project, NAMES)


def test_a_file_that_leads_nowhere_and_a_config_without_a_folder_are_refused(project):
    (project / "ch3.yaml").symlink_to("nowhere")
    for folder in (project, project / "gone"):
        with pytest.raises(InputError):
            check_config_files(folder, NAMES)


@pytest.fixture
def outside(project):
    """A folder outside of the project, and ways to its file."""
    folder = project.parent / "outside"
    folder.mkdir()
    (folder / "scan.csv").write_text("\n".join(f"{height % 7}.0" for height in range(50)))
    (project / "link.csv").symlink_to(folder / "scan.csv")
    (project / "folder").symlink_to(folder)
    return folder


def test_measured_heights_are_read_from_the_projects_folder_and_from_those_that_are_named(project, outside):
    ways = (
        "../outside/scan.csv",
        "src/../../outside/scan.csv",
        str(outside / "scan.csv"),
        "link.csv",
        "folder/scan.csv",
    )
    for way in ways:
        with pytest.raises(ValueError, match="data_folders"):
            data_file(way, ["src", "../out"])
        assert data_file(way, ["../outside"]) == data_file(way, [str(outside)]) == (outside / "scan.csv").resolve()
    assert data_file("src/scan.csv", []) == (project / "src/scan.csv").resolve()


def measured(file, folders):
    """A study of measured heights."""
    section = {key: ROUGH[key] for key in ("title", "body", "effects", "tolerance")} | {
        "surface": {"kind": "measured", "file": str(file), "spacing": 1.0, "unit": "nm"},
        "load": {"mean_pressure": [0.1]},
    }
    return Study.read("scan", section, "ch9.yaml", 1, folders)


def test_a_study_refuses_a_file_elsewhere_unless_its_folder_is_named(project, outside):
    assert len(measured("link.csv", ["../outside"]).runs()) == 1
    assert len(measured(outside / "scan.csv", None).runs()) == 1
    for file, reason in (("link.csv", "data_folders"), ("/dev/zero", "data_folders"), ("gone.csv", "looked for at")):
        with pytest.raises(InputError) as caught:
            measured(file, [])
        assert (caught.value.key, caught.value.value) == ("studies.scan.surface.file", file)
        assert reason in str(caught.value)


def test_what_is_no_file_is_not_read(project):
    for file in ("/dev/zero", project):
        with pytest.raises(InputError, match="a file that can be read"):
            measured(file, None)
