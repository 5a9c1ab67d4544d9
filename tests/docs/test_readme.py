"""The commands, snippets, numbers and links of the README and of docs/ are true."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml

import contactsim
from contactsim.analysis.quantities import FITTED
from contactsim.analysis.reductions import ORDERS, REDUCTIONS, reduction_inputs
from contactsim.evaluation.calibration import settings as calibration
from contactsim.evaluation.effects import map_settings
from contactsim.evaluation.identification import settings as identification
from contactsim.evaluation.identification.admission import Limits
from contactsim.evaluation.robustness.survey import ROBUSTNESS_KEYS
from contactsim.evaluation.work_precision import prices
from contactsim.evaluation.work_precision.case_config import CASE_KEYS, KEPT_TIERS
from contactsim.evaluation.work_precision.knobs import SETTING_KEYS
from contactsim.interface.registry import EFFECTS
from contactsim.status import FLAGS, LIMITS, Status
from contactsim.study.claim_keys import CLAIM_KEYS
from contactsim.study.figure_plan import FIGURE_KEYS, FILM_KEYS
from contactsim.study.keys import (
    ACCURACY_KEYS,
    ERROR_RUNS,
    MODULI,
    NEGLECT_KEYS,
    PATH_KEYS,
    SECTION_KINDS,
    SLIDE_KEYS,
    STUDY_KEYS,
)
from contactsim.study.law_table import LAW_KEYS
from contactsim.study.plan import CONFIG_KEYS, TIER_KEYS, Plan
from contactsim.study.reading import REQUIRED, keys_of
from contactsim.study.study import Study
from contactsim.variables import LOADS
from support.places import ROOT
from support.project import CYLINDER, Project
from support.small_studies import PROJECT, SMALL, small_section

PAGES = {
    page: (ROOT / page).read_text(encoding="utf-8")
    for page in (
        "README.md",
        "docs/python.md",
        "docs/conventions.md",
        "docs/workflow.md",
        "docs/accuracy.md",
        "docs/architecture.md",
        "docs/cluster.md",
        "benchmarks/README.md",
        "config/README.md",
    )
}
USER_PAGES = "\n".join(text for page, text in PAGES.items() if page not in ("benchmarks/README.md", "config/README.md"))
KEYS = (ROOT / "config/README.md").read_text(encoding="utf-8")


def blocks(language):
    return re.findall(rf"^```{language}\n(.*?)^```", USER_PAGES, re.MULTILINE | re.DOTALL)


def test_the_python_of_the_readme_runs_and_reconstructs_the_solution(made, monkeypatch):
    monkeypatch.chdir(made)
    names = {}
    for block in blocks("python"):
        exec(block.replace("results/standard", "results/quick"), names)
    modulus, load = names["modulus"], names["k"]
    step = np.sqrt(np.mean(np.diff(names["heights"], append=names["heights"][0]) ** 2))
    # the pressure is stored in single precision: about 1e-4 steps
    assert np.abs(names["gap"][names["contact"]]).max() < 2e-3 * step
    assert names["gap"].min() > -2e-3 * step
    again = contactsim.press(
        names["heights"],
        spacing=names["length"] / names["n"],
        contact_modulus=modulus,
        mean_pressure=float(names["run"]["mean_pressure"][load]),
    )
    assert np.array_equal(again.contact, names["contact"])
    assert np.allclose(again.pressure, names["pressure"], rtol=1e-5, atol=1e-7 * again.pressure.max())
    assert np.allclose(again.gap, names["gap"], atol=2e-3 * step)
    law, gap, step = names["Morse"](0.8, 1.5), np.linspace(-4.0, 6.0, 60)[None], 1e-6
    between = [law.traction(gap + step) - law.traction(gap - step), law.energy(gap + step) - law.energy(gap - step)]
    assert np.allclose(law.tangent(gap)[1][0], between[0] / (2 * step), atol=1e-6)
    assert np.allclose(law.traction(gap)[0], between[1] / (2 * step), atol=1e-6)
    assert np.isclose(law.traction(np.linspace(0, 6, 2000)[None]).max(), law.strength, rtol=1e-5)
    assert names["pressed"].status.values.max() == 0


def test_the_conventions_have_every_status_and_limit():
    page = PAGES["docs/conventions.md"]
    for status in Status:
        assert f"| {status.value[0]} | `{status.name}` | {status.sentence} |" in page
    for name, (limit, words) in LIMITS.items():
        assert f"| {FLAGS[name]} | `{name}`, {words} | {limit:g} |" in page


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    """A project of the studies that the README names, small, with make, a test, a scene and the example."""
    project = Project.new(tmp_path_factory.mktemp("readme") / "project")
    folder = project.folder
    for file in (folder / "config").glob("ch*.yaml"):
        file.unlink()
    for chapter, studies in SMALL.items():
        content = yaml.safe_load((ROOT / f"config/{chapter}.yaml").read_text(encoding="utf-8"))
        (name,) = studies
        own = {"studies": {name: small_section(chapter, name)}, "figures": {}}
        if chapter == "ch3":
            own["figures"] = {"fig_3_2": content["figures"]["fig_3_2"]}
        project.configure(chapter, own)
    project.configure("tiers", {"standard": {}, "quick": {}, "full": {}})
    scene = {key: value for key, value in CYLINDER.items() if key != "title"}
    (folder / "scene.yaml").write_text(yaml.safe_dump(scene | {"title": "A cylinder"}), encoding="utf-8")
    for name in ("Makefile", "pyproject.toml", *PROJECT[:-1], "tests/test_grid.py", "profiles/slurm/config.yaml"):
        (folder / name).parent.mkdir(exist_ok=True, parents=True)
        shutil.copy2(ROOT / name, folder / name)
    (folder / ".venv").mkdir()
    for name in ("bin", "lib", "pyvenv.cfg"):
        (folder / ".venv" / name).symlink_to(Path(sys.prefix) / name)
    (folder / ".venv/.ready").touch()
    return project


@pytest.mark.slow
def test_every_command_of_the_readme_does_what_it_is_there_for(project):
    lines = [line.partition("  #")[0].strip() for block in blocks("sh") for line in block.splitlines()]
    assert len(lines) > 12
    environment = project.environment(PATH=f"{project.folder / '.venv/bin'}:{os.environ['PATH']}")
    for line in lines:
        in_bundle = line.startswith(("sha256sum", "python examples"))
        folder = project.folder / "results/standard/bundle" if in_bundle else project.folder
        command = f"{line} --dry-run" if "profiles/slurm" in line else line  # there is no Slurm here
        done = subprocess.run(command, shell=True, cwd=folder, env=environment, capture_output=True, text=True)
        assert done.returncode == 0, f"{command}\n{done.stdout}\n{done.stderr}"
    made = {str(file.relative_to(project.folder)) for file in project.folder.rglob("*") if file.is_file()}
    assert {"sketch.png", "scene.nc", "results/standard/figures/fig_3_2.png", "results/standard/report.html"} <= made
    assert {"results/quick/figures/fig_3_2.png", "results/standard/bundle/SHA256SUMS"} <= made


def test_the_study_of_the_readme_can_be_added_to_the_config(made, tmp_path, monkeypatch):
    monkeypatch.chdir(made)
    np.savetxt(
        "profile.csv",
        np.c_[np.arange(50) / 100, np.sin(np.arange(50))],
        delimiter=",",
        header="x [um], z [nm]",
        comments="",
    )
    (block,) = [block for block in blocks("yaml") if "my_profile" in block]
    for file in (ROOT / "config").glob("*.yaml"):
        text = file.read_text(encoding="utf-8")
        (tmp_path / file.name).write_text(
            text.replace("studies:\n", f"studies:\n{block}\n", 1) if file.stem == "ch3" else text
        )
    plan = Plan.read(tmp_path, "quick")
    assert plan.studies["my_profile"].settings["surface"]["file"] == "profile.csv"
    assert set(Plan.read(ROOT / "config", "quick").studies) == set(plan.studies) - {"my_profile"}


def test_what_the_readme_asks_of_a_study_is_understood():
    body = {"kind": "half_space", "youngs_modulus": 70.0, "poisson_ratio": 0.45}
    scene = {"title": "One", "surface": {"kind": "cylinder", "radius": 1e4, "length": 4e3}, "body": body}
    law = {"cohesive_zone": {"work_of_separation": 1.0}, "path": {"approach": [-6.0, 14.0]}}
    asked = [yaml.safe_load(block) for block in blocks("yaml") if "title:" not in block]
    assert len(asked) == 2
    both = Study.read("one", scene | law | asked[0] | asked[1], "README.md", 1)
    assert both.settings["accuracy"]["error"] == 0.01
    assert both.settings["auto"]["neglect_within"] == 0.05


def test_every_command_names_a_target_or_an_option_that_exists():
    targets = set(Plan.read(ROOT / "config").figures) | {
        "all",
        "stability",
        "test",
        "setup",
        "docs",
        "help",
        "my_profile",
        "smooth_line",
        "rough_line",
        "claims",
        "effect_maps",
        "trials",
        "bundle",
        "report",
        "gallery",
        "accuracy",
        "overview",
        "price_of_accuracy",
        "robustness",
        "effects",
        "export_baselines",
    }
    commands = re.findall(r"(?:^make|`make|snakemake --cores 2) (\w+)", USER_PAGES, re.MULTILINE)
    assert commands
    assert set(commands) <= targets


def test_what_is_said_of_the_trials_is_what_their_table_holds():
    trials, words = pd.read_csv(ROOT / "docs/trials.csv"), " ".join(PAGES["docs/accuracy.md"].split())
    reached, finite = trials[trials.accuracy_reached == 1], trials[np.isfinite(trials.predicted_error)]
    assert len(trials) >= 200
    assert f"tested on {len(trials)} random scenes" in words
    assert f"{finite.covered.sum()} of {len(finite)} stated errors cover the true error" in words
    assert f"{reached.met.sum()} of {len(reached)} runs that say that they reached the error are within it" in words
    assert f"The runs take {trials.cost.median():.2g} times (median) the CPU time of the cheapest" in words


def test_nothing_on_a_page_waits_to_be_filled_in():
    assert not re.search(r"^[A-Z]{6,}$|: [A-Z]{6,}$|TODO", USER_PAGES, re.MULTILINE)


def test_every_figure_stands_among_the_targets():
    page = PAGES["docs/workflow.md"]
    table = page[page.index("| target |") : page.index("| `all` |")]
    assert set(Plan.read(ROOT / "config").figures) <= set(re.findall(r"`(\w+)`", table))


def test_every_link_leads_somewhere():
    for page, text in PAGES.items():
        folder = (ROOT / page).parent
        for link, anchor in re.findall(r"\]\(([^)#:]*)(?:#([^)]+))?\)", text):
            target = folder / link if link else ROOT / page
            assert target.exists(), link
            if anchor:
                headings = re.findall(r"^#+ (.+)$", target.read_text(encoding="utf-8"), re.MULTILINE)
                assert anchor in {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


TABLES = [
    *(
        CONFIG_KEYS,
        TIER_KEYS,
        STUDY_KEYS,
        FIGURE_KEYS,
        FILM_KEYS,
        ROBUSTNESS_KEYS,
        ACCURACY_KEYS,
        NEGLECT_KEYS,
        dict.fromkeys(LOADS),
    ),
    *(
        calibration.KEYS,
        calibration.DRAW_KEYS,
        map_settings.KEYS,
        map_settings.MAP_KEYS,
        map_settings.AXIS_KEYS,
        map_settings.PANEL_KEYS,
    ),
    *(identification.KEYS, identification.RANGE_KEYS, identification.RUN_KEYS, keys_of(Limits)),
    prices.KEYS,
    *((KEPT_TIERS,), CLAIM_KEYS, FITTED, CASE_KEYS, SETTING_KEYS, PATH_KEYS, SLIDE_KEYS, LAW_KEYS),
    *(keys for _, _, keys in ERROR_RUNS.values()),
]
"""All tables of keys that a config may have."""


@pytest.mark.parametrize("keys", TABLES)
def test_every_key_is_explained(keys):
    for name in keys:
        assert f"`{name}`" in KEYS, name


@pytest.mark.parametrize("reduction", [*REDUCTIONS, *ORDERS])
def test_every_reduction_is_explained_with_what_it_uses(reduction):
    uses = ", ".join(f"`{name}`" for name in reduction_inputs(reduction))
    assert re.search(rf"^\| `{reduction}` \| .+ \| {uses} ?\|$", KEYS, re.MULTILINE)


@pytest.mark.parametrize("effect", EFFECTS)
def test_every_option_of_an_effect_is_explained_with_its_default(effect):
    part = KEYS[KEYS.index("### Effects") :].split("\n### ")[0]
    for name, key in keys_of(EFFECTS[effect]).items():
        own = part[part.index(f"| `{effect}`") :]
        row = re.search(rf"^.*\| `{name}` \|.*$", own, re.MULTILINE)
        default = row[0].rstrip("| ").rpartition("|")[2].strip()
        words = {REQUIRED: "required", None: "none"}.get(key.default)
        assert default == (words or f"{key.default:g}"), name


@pytest.mark.parametrize("section", [section for section in SECTION_KINDS if section != "counter_body"])  # as `body`
def test_every_kind_and_its_keys_are_explained_with_their_defaults(section):
    known, class_of = SECTION_KINDS[section]
    for kind in known:
        part = KEYS[KEYS.index(f"### `{section}`") :]
        block = part[part.index(f"| `{kind}` |") :].split("\n\n")[0]
        own = re.split(r"\n\| `", block)[0]
        for name, key in keys_of(class_of(kind)).items():
            row = re.search(rf"^.*\| `{name}` \|.*$", own, re.MULTILINE)
            assert row, f"{kind}.{name}"
            default = row[0].rstrip("| ").rpartition("|")[2].strip()
            if isinstance(key.default, int | float):
                assert float(default) == key.default, f"{kind}.{name}"


def test_the_settings_reference_explains_no_key_that_is_gone():
    known = {"kind", *REDUCTIONS, *ORDERS, *EFFECTS, *MODULI, *(name for keys in TABLES for name in keys)}
    known |= {name for law in EFFECTS.values() for name in keys_of(law)}
    for classes, class_of in SECTION_KINDS.values():
        for kind in classes:
            known |= {kind, *keys_of(class_of(kind))}
    for name in re.findall(r"^\| (?:`\w+` )?\|? ?`(\w+)` \|", KEYS, re.MULTILINE):
        assert name in known, name


@pytest.mark.parametrize("section", ["solver", "surface", "body", "increments"])
def test_every_kind_is_explained_once(section):
    own = KEYS.split(f"### `{section}`", 1)[1].split("\n##")[0]
    kinds = re.findall(r"^\| `(\w+)` \|", own, re.MULTILINE)
    assert len(kinds) == len(set(kinds)) >= 2


def test_every_package_is_shown():
    page = PAGES["docs/architecture.md"]
    table = page[page.index("| package of") :]
    packages = {file.parent.name for file in (ROOT / "src/contactsim").glob("*/__init__.py")}
    assert packages <= set(re.findall(r"`(\w+)`", table))


def test_the_citation_file_is_valid_yaml_and_names_the_thesis():
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert citation["references"][0]["title"] == "Modelling adhesion and friction in contact problems"
    assert citation["version"] == contactsim.provenance.versions()["contactsim"]
