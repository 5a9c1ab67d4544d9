"""Which jobs an edit runs again: what each rule is given, before and after."""

from __future__ import annotations

import ast
import shutil
from copy import deepcopy
from pathlib import Path

import pytest
import yaml

from contactsim import code_digest
from contactsim.provenance import canonical
from contactsim.study import stages
from contactsim.study.execute import point_digests
from contactsim.study.plan import Plan

SOURCE = Path(code_digest.__file__).parent
CYLINDER = {"kind": "cylinder", "radius": 10.0, "length": 40.0}
WALL = {
    "title": "Cylinder",
    "surface": CYLINDER,
    "body": {"kind": "half_space", "contact_modulus": 1.0},
    "effects": ["hard_wall"],
    "load": {"contact_ratio": [0.1, 0.2]},
    "points": 64,
    "members": 2,
    "tolerance": 1e-3,
}
STICKY = {
    "title": "Adhesive cylinder",
    "surface": CYLINDER,
    "body": {"kind": "half_space", "contact_modulus": 1.0, "poisson_ratio": 0.3},
    "effects": ["cohesive_zone"],
    "cohesive_zone": {"work_of_separation": 0.1, "work_ratio": 0.0, "normal_length": 1.0, "tangential_length": 1.0},
    "path": {"approach": [-4.0, 1.0], "increment": 0.5},
    "points": 64,
    "tolerance": 1e-5,
}
FIGURE = {"title": "Figure", "caption": "What it shows.", "size": [12.0, 3.0]}
FACTORS = FIGURE | {"panels": 4, "reference": {"kappa_r": 1.75}}
CONFIG = {
    "config.yaml": {"seed": 1, "tier": "plain", "results": "made"},
    "tiers.yaml": {"plain": {}},
    "ch3.yaml": {
        "studies": {"wall": WALL, "keer": WALL | {"solver": {"kind": "polonsky_keer"}}},
        "figures": {"fig_3_2": FACTORS | {"study": "wall"}, "fig_3_3": FIGURE | {"study": "keer"}},
    },
    "ch4.yaml": {"studies": {"sticky": STICKY}, "figures": {"fig_4_2": FIGURE | {"study": "sticky", "panels": 2}}},
}
RUNS = {"run wall", "run keer", "run sticky"}
AGGREGATED = {"dataset wall", "dataset keer", "dataset sticky"}
FIGURES = {"fig_3_2", "fig_3_3", "fig_4_2"}
ALL = RUNS | AGGREGATED | FIGURES


def everything_after(*runs: str) -> set[str]:
    """Return these runs and what is made of them."""
    figures = {"wall": "fig_3_2", "keer": "fig_3_3", "sticky": "fig_4_2"}
    return {job for run in runs for job in (f"run {run}", f"dataset {run}", figures[run])}


class Workshop:
    """A copy of the package, and a config, that may be edited."""

    def __init__(self, folder: Path) -> None:
        self.package, self.config = folder / "contactsim", folder / "config"
        shutil.copytree(SOURCE, self.package, ignore=shutil.ignore_patterns("__pycache__"))
        self.config.mkdir()
        self.configure(CONFIG)

    def configure(self, files: dict) -> None:
        for name, content in files.items():
            (self.config / name).write_text(yaml.safe_dump(content, sort_keys=False), encoding="utf-8")

    def change(self, file: str, key: str, value: object) -> None:
        """Change a value of the config; key: with slashes."""
        files = deepcopy(CONFIG)
        *outer, last = key.split("/")
        section = files[file]
        for name in outer:
            section = section[name]
        section[last] = value
        self.configure(files)

    def edit(self, module: str, how) -> None:
        """Replace the source of a module by what `how` makes of it."""
        path = self.package / f"{module}.py"
        path.write_text(how(path.read_text(encoding="utf-8")), encoding="utf-8")

    def plan(self) -> Plan:
        """Read the config, as the next command does."""
        forget()
        return Plan.read(self.config)

    def jobs(self) -> dict[str, str]:
        """Return what each job is given, by the job: runs, datasets and figures."""
        plan = self.plan()
        jobs = {
            f"run {study.name} {run.stem} {run.measures_error}": canonical([run.settings, run.source])
            for study in plan.studies.values()
            for run in study.runs()
        }
        jobs |= {f"dataset {name}": canonical(plan.study_settings(name)) for name in plan.studies}
        return jobs | {name: canonical(plan.figure_settings(name)) for name in plan.figures}


def forget() -> None:
    for cached in (
        code_digest.read_source,
        code_digest.source_digest,
        stages.stage_digest,
        stages.computing_stage_digest,
        stages.run_digest,
    ):
        cached.cache_clear()


@pytest.fixture
def workshop(tmp_path, monkeypatch):
    workshop = Workshop(tmp_path)
    monkeypatch.setattr(code_digest, "package_root", lambda: workshop.package)
    yield workshop
    forget()


def changed(before: dict[str, str], after: dict[str, str]) -> set[str]:
    """Return the jobs that are given something else; runs by their study."""
    different = {job for job in before | after if before.get(job) != after.get(job)}
    return {" ".join(job.split()[:2]) for job in different}


def with_a_comment(text: str) -> str:
    return "# Better said.\n" + text + "\n# The end.\n"


def with_other_docstrings(text: str) -> str:
    tree = ast.parse(text)
    for node in ast.walk(tree):
        if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef)) and ast.get_docstring(node):
            node.body[0].value.value = "Something else."
    return ast.unparse(tree)


def laid_out_anew(text: str) -> str:
    return ast.unparse(ast.parse(text))


def computing_more(text: str) -> str:
    return text + "\nEDITED = 1\n"


MODULES = [
    "grid",
    "interface/cohesive_zone",
    "solvers/hard_wall/active_set",
    "paths/record",
    "study/execute",
    "figures/ch3",
]


@pytest.mark.parametrize("how", [with_a_comment, with_other_docstrings, laid_out_anew])
def test_an_edit_of_words_alone_runs_nothing(workshop, how):
    before = workshop.jobs()
    for module in MODULES:
        path = workshop.package / f"{module}.py"
        text = path.read_text(encoding="utf-8")
        workshop.edit(module, how)
        assert path.read_text(encoding="utf-8") != text
    assert changed(before, workshop.jobs()) == set()


@pytest.mark.parametrize(
    ("module", "expected"),
    [
        ("grid", ALL),
        ("elasticity/half_space", ALL),
        ("elasticity/layer", {"fig_4_2"}),  # figures of Chapter 4 compare with it
        ("surfaces/shapes", ALL),
        ("surfaces/measured", set()),
        ("interface/cohesive_zone", everything_after("sticky")),
        ("interface/repulsion", set()),
        ("interface/lattice", set()),
        ("contact/certificate", ALL),  # of all solvers
        ("contact/hard_wall", everything_after("wall", "keer")),
        ("contact/pose_hard_wall", everything_after("wall", "keer")),
        ("contact/cohesive", everything_after("sticky")),
        ("solvers/hard_wall/active_set", everything_after("wall")),
        ("solvers/hard_wall/polonsky_keer", everything_after("keer")),
        ("solvers/hard_wall/verlet", set()),
        ("solvers/cohesive/newton_krylov", everything_after("sticky")),
        ("solvers/cohesive/zone_factors", everything_after("sticky")),
        ("solvers/cohesive/damped_verlet", set()),
        ("paths/pressures", everything_after("wall", "keer")),
        ("paths/continuation", everything_after("sticky")),
        ("paths/nested", set()),
        ("error_control/ladder", set()),
        ("analysis/aggregate", AGGREGATED | FIGURES),
        ("analysis/costs", AGGREGATED | FIGURES),
        ("analysis/claims", set()),
        ("figures/ch3", {"fig_3_2", "fig_3_3"}),
        ("figures/ch4", {"fig_4_2"}),
        ("figures/style", FIGURES),
        ("evaluation/robustness/judge", set()),
        ("publish/report", set()),
        ("study/plan", set()),
        ("seals", set()),
        ("cli", set()),
    ],
)
def test_an_edit_of_code_runs_the_jobs_that_execute_it_and_what_follows(workshop, module, expected):
    before = workshop.jobs()
    workshop.edit(module, computing_more)
    assert changed(before, workshop.jobs()) == expected


@pytest.mark.parametrize(
    ("before", "after", "expected"),
    [
        (r"$\kappa$", r"$K$", AGGREGATED | FIGURES),
        (",relative contact area,", ",contact area over the whole,", AGGREGATED | FIGURES),
        ("mean_gap,nm,", "mean_gap,m,", AGGREGATED | FIGURES),
    ],
    ids=["symbol", "long name", "unit"],
)
def test_an_edit_of_a_symbol_a_unit_or_a_long_name_runs_no_simulation(workshop, before, after, expected):
    jobs, table = workshop.jobs(), workshop.package / "variables.csv"
    text = table.read_text(encoding="utf-8")
    assert before in text
    table.write_text(text.replace(before, after), encoding="utf-8")
    assert changed(jobs, workshop.jobs()) == expected


@pytest.mark.parametrize(
    ("file", "key", "value", "expected"),
    [
        ("ch3.yaml", "studies/wall/tolerance", 1e-4, everything_after("wall")),
        ("ch3.yaml", "studies/wall/points", 128, everything_after("wall")),
        ("ch3.yaml", "studies/wall/title", "Another", {"dataset wall", "fig_3_2"}),
        ("ch4.yaml", "studies/sticky/cohesive_zone/work_of_separation", 0.2, everything_after("sticky")),
        ("ch4.yaml", "studies/sticky/path/increment", 0.25, everything_after("sticky")),
        ("ch3.yaml", "studies/wall/thesis_points", 9, {"dataset wall", "fig_3_2"}),
        ("ch3.yaml", "figures/fig_3_2/compare", ["kappa_r"], set()),
        ("ch3.yaml", "figures/fig_3_2/caption", "Something else.", {"fig_3_2"}),
        ("ch3.yaml", "figures/fig_3_3/size", [9.0, 3.0], {"fig_3_3"}),
        ("config.yaml", "seed", 2, ALL),
        ("ch3.yaml", "studies/wall/body", {"kind": "half_space", "contact_modulus": 2.0}, everything_after("wall")),
        ("ch3.yaml", "studies/wall/load/contact_ratio", [0.2, 0.1], set()),  # in another order
        ("ch3.yaml", "studies/wall/tolerance", 0.001, set()),  # the same number
        ("ch3.yaml", "studies/wall/coarse_grid", {"points": 32, "members": 1}, everything_after("wall")),
        ("ch3.yaml", "studies/wall/keep", ["contact", "profile"], everything_after("wall")),
        ("ch3.yaml", "studies/keer/solver/kind", "active_set", everything_after("keer")),
        ("ch4.yaml", "studies/sticky/body/poisson_ratio", 0.2, everything_after("sticky")),
        ("ch4.yaml", "studies/sticky/cohesive_zone/work_ratio", 0.1, everything_after("sticky")),
        ("ch4.yaml", "studies/sticky/increments", {"kind": "adaptive"}, everything_after("sticky")),
        ("ch3.yaml", "figures/fig_3_2/reference/kappa_r", 1.8, {"fig_3_2"}),
        ("tiers.yaml", "plain", {"studies": {"wall": {"points": 128}}}, everything_after("wall")),
        ("tiers.yaml", "other", {"studies": {"wall": {"points": 128}}}, set()),
    ],
)
def test_an_edit_of_the_config_runs_what_uses_the_value(workshop, file, key, value, expected):
    before = workshop.jobs()
    workshop.change(file, key, value)
    assert changed(before, workshop.jobs()) == expected


def test_an_added_pressure_runs_the_sweeps_of_its_study_which_keep_the_load_steps_they_have(workshop):
    def steps() -> set[str]:
        run = workshop.plan().studies["wall"].runs()[0]
        return set(point_digests(run.settings, run.source, len(run.setup.scene.path.steps)))

    before, steps_before = workshop.jobs(), steps()
    workshop.change("ch3.yaml", "studies/wall/load", {"contact_ratio": [0.1, 0.15, 0.2]})
    assert changed(before, workshop.jobs()) == everything_after("wall")
    assert steps_before < steps()


def test_added_members_leave_the_runs_that_are_there(workshop):
    before = workshop.jobs()
    workshop.change("ch3.yaml", "studies/wall/members", 4)
    after = workshop.jobs()
    runs = {job: settings for job, settings in before.items() if job.startswith("run ")}
    assert runs.items() < after.items()
    assert changed(before, after) == everything_after("wall")
