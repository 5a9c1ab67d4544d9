"""A small project of its own: this repository's workflow and package under the tests' config."""

from __future__ import annotations

import compileall
import contextlib
import hashlib
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from support.places import ROOT

REPORT = "report: "  # it shows all, so it follows every edit, as one test says
PATIENCE = 60  # seconds until a test gives up; what it waits for takes a second or two

CYLINDER = {
    "title": "Cylinder",
    "surface": {"kind": "cylinder", "radius": 1.0e6, "length": 4.0e6},
    "body": {"kind": "half_space", "contact_modulus": 1.0},
    "effects": ["hard_wall"],
    "load": {"contact_ratio": [0.1, 0.2, 0.3]},
    "points": 512,
    "tolerance": 1.0e-3,
}
ROUGH = {
    "title": "Rough line",
    "surface": {
        "kind": "self_affine",
        "hurst_exponent": 0.8,
        "length": 160000.0,
        "long_cutoff": 20000.0,
        "short_cutoff": 1250.0,
        "rms_gradient": 0.001,
        "amplitudes": "gaussian",
    },
    "vary": {"surface.hurst_exponent": [0.3, 0.8]},
    "body": {"kind": "half_space", "contact_modulus": 1.0},
    "effects": ["hard_wall"],
    "load": {"reduced_pressure": [0.01, 0.1, 0.5]},
    "points": 2048,
    "members": 2,
    "coarse_grid": {"points": 1024, "members": 1},
    "tolerance": 1.0e-3,
}


def figure(study: str) -> dict:
    """A figure's block in the config."""
    return {"study": study, "title": f"Figure of {study}", "caption": "As in the config.", "size": [3.0, 2.0]}


CONFIG = {
    "ch8": {
        "studies": {"rough": ROUGH, "baseline": CYLINDER | {"solver": {"kind": "polonsky_keer"}}},
        "figures": {"fig_8_1": figure("rough"), "fig_8_2": figure("rough"), "fig_8_3": figure("baseline")},
    },
    "ch9": {"studies": {"smooth": CYLINDER | {"points": 8192}}, "figures": {"fig_9_1": figure("smooth")}},
    "tiers": {"standard": {}, "quick": {"studies": {"smooth": {"points": 256}}}},
}
DRAW = """
def {name}(data, axes):
    axes.plot(data.relative_contact_area.values.ravel())
    return data[["relative_contact_area_mean"]].to_dataframe().reset_index()
"""
HOOK = """
# Stop or fail a job where it says, or replaces, what CONTACTSIM_TEST_AT matches.
import logging, os, pathlib, re, time

def reached(text):
    if not re.search(os.environ["CONTACTSIM_TEST_AT"], text):
        return
    if "CONTACTSIM_TEST_PAUSE" not in os.environ:
        raise RuntimeError("made to fail")
    folder = pathlib.Path(os.environ["CONTACTSIM_TEST_PAUSE"])
    (folder / "part").write_text(str(os.getpid()))
    (folder / "part").rename(folder / "pid")
    end = time.monotonic() + 60
    while not (folder / "go").exists() and time.monotonic() < end:
        time.sleep(0.02)

if "CONTACTSIM_TEST_AT" in os.environ:
    make, replace = logging.getLogRecordFactory(), os.replace

    def record(*args, **options):
        made = make(*args, **options)
        if made.name == "contactsim.paths.pressures":
            reached(made.getMessage())
        return made

    def replaced(source, target, **options):
        replace(source, target, **options)
        reached(f"replaced {target}")

    logging.setLogRecordFactory(record)
    os.replace = replaced
"""


@dataclass(frozen=True)
class Project:
    """A project in a folder of its own: what it plans, what it makes, and what lies there."""

    folder: Path

    @classmethod
    def new(cls, folder: Path) -> Project:
        """This repository's workflow and package under the tests' config, nothing made."""
        unwanted = shutil.ignore_patterns("__pycache__", "*.egg-info")
        for name in ("workflow", "profiles", "src"):
            shutil.copytree(ROOT / name, folder / name, ignore=unwanted)
        shutil.copy2(ROOT / "Snakefile", folder)
        (folder / "config").mkdir()
        main = yaml.safe_load((ROOT / "config/config.yaml").read_text(encoding="utf-8"))
        project = cls(folder)
        project.configure("config", main | {"tier": "standard", "results": "results"})
        for name, content in CONFIG.items():
            project.configure(name, content)
            figures = [DRAW.format(name=figure) for figure in content.get("figures", {})]
            if figures:
                (folder / f"src/contactsim/figures/{name}.py").write_text("".join(figures), encoding="utf-8")
        (folder / "hooks").mkdir()
        (folder / "hooks/sitecustomize.py").write_text(HOOK, encoding="utf-8")
        compileall.compile_dir(folder / "src", quiet=1)
        return project

    def copied(self, folder: Path) -> Project:
        """A copy with all times as they are."""
        shutil.copytree(self.folder, folder, symlinks=True)
        return Project(folder)

    def configure(self, name: str, content: dict, ordered: bool = True) -> None:
        """Write one file of the config."""
        text = yaml.safe_dump(content, sort_keys=ordered)
        (self.folder / f"config/{name}.yaml").write_text(text, encoding="utf-8")

    def change(self, chapter: str, path: str, value: object) -> None:
        """Set one value of a chapter, its key given with dots."""
        content = yaml.safe_load((self.folder / f"config/{chapter}.yaml").read_text(encoding="utf-8"))
        *sections, key = path.split(".")
        section = content
        for name in sections:
            section = section[name]
        section[key] = value
        self.configure(chapter, content)

    def edit(self, module: str, line: str = "EDITED = True") -> None:
        """Append a line to a module of the project's package."""
        with (self.folder / f"src/contactsim/{module}.py").open("a", encoding="utf-8") as file:
            file.write(f"\n{line}\n")

    def command(self, *arguments: str) -> list[str]:
        """The snakemake command line."""
        return [sys.executable, "-m", "snakemake", *arguments]

    def environment(self, **more: str) -> dict[str, str]:
        """The environment in which the project's own package and the hook are found first."""
        clean = {name: value for name, value in os.environ.items() if not name.startswith(("SNAKEMAKE", "CONTACTSIM"))}
        return clean | {"PYTHONPATH": f"{self.folder / 'hooks'}:{self.folder / 'src'}"} | more

    def snakemake(self, *arguments: str, **more: str) -> subprocess.CompletedProcess[str]:
        """Run snakemake here, whatever comes of it."""
        return subprocess.run(
            self.command(*arguments),
            cwd=self.folder,
            env=self.environment(**more),
            capture_output=True,
            text=True,
            timeout=PATIENCE * 2,
            check=False,
        )

    def make(self, *targets: str, options: tuple[str, ...] = ()) -> list[str]:
        """Make targets, without fail; returns the jobs that this took."""
        done = self.snakemake("--logger-progress-full", *options, "--", *targets)
        assert done.returncode == 0, done.stderr
        return jobs_in(done.stdout + done.stderr)

    def planned(self, *targets: str, options: tuple[str, ...] = ()) -> list[str]:
        """The jobs that making these targets would take, by a dry run."""
        done = self.snakemake("-n", "--quiet", "host", "reason", *options, "--", *targets)
        assert done.returncode == 0, done.stderr
        return jobs_in(done.stdout + done.stderr)

    def files(self, *patterns: str) -> dict[str, str]:
        """Digests of the files that match."""
        found = sorted(file for pattern in patterns for file in self.folder.glob(f"results/{pattern}"))
        return {str(file.relative_to(self.folder)): hashlib.sha256(file.read_bytes()).hexdigest() for file in found}

    def science(self, study: str, tier: str = "standard") -> dict[str, str]:
        """Digests of a study's run files and of its dataset."""
        files = self.files(f"{tier}/runs/{study}/*/*.nc", f"{tier}/datasets/*_{study}.nc")
        assert {name.split("/")[2] for name in files} == {"datasets", "runs"}
        return files

    def times(self, pattern: str) -> dict[str, int]:
        """Times of last change of the files that match."""
        return {str(file): file.stat().st_mtime_ns for file in self.folder.glob(f"results/{pattern}")}

    def run_targets(self, study: str) -> list[str]:
        """Targets that make a study's runs and nothing more; in a project that has them already."""
        return [
            str(file.relative_to(self.folder)) for file in self.folder.glob(f"results/standard/runs/{study}/*/*.done")
        ]

    def logs(self, study: str) -> dict[str, str]:
        """What the run jobs of a study said last, by variant/member."""
        folder = self.folder / f"results/standard/logs/runs/{study}"
        return {str(file.relative_to(folder)): file.read_text(encoding="utf-8") for file in folder.glob("*/*.log")}

    def steps(self, study: str) -> set[tuple[int, int]]:
        """How many loads each run job of a study took over and how many it computed, in its last call."""
        return {
            (text.count("taken over"), len(re.findall(r"step \d+/\d+ .* residual ", text)))
            for text in self.logs(study).values()
        }

    @contextlib.contextmanager
    def paused(self, at: str, *arguments: str, stderr: Any = subprocess.DEVNULL) -> Iterator[Pause]:
        """A snakemake of which one job has come to `at` and waits there; at the end nothing is left running."""
        signs = self.folder / "signs"
        signs.mkdir()
        process = subprocess.Popen(
            self.command(*arguments),
            cwd=self.folder,
            env=self.environment(CONTACTSIM_TEST_AT=at, CONTACTSIM_TEST_PAUSE=str(signs)),
            stdout=subprocess.DEVNULL,
            stderr=stderr,
            start_new_session=True,
            preexec_fn=hear_ctrl_c,
        )
        try:
            wait_for(lambda: (signs / "pid").exists() or process.poll() is not None)
            assert process.poll() is None, f"snakemake ended before a job came to {at!r}"
            yield Pause(process, int((signs / "pid").read_text()), signs)
        finally:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
            process.wait(PATIENCE)
            shutil.rmtree(signs)


@dataclass(frozen=True)
class Pause:
    """A snakemake and its job that waits."""

    process: subprocess.Popen
    job: int
    signs: Path

    def kill_job(self) -> None:
        """kill -9 of the job alone; snakemake sees it fail and ends."""
        os.kill(self.job, signal.SIGKILL)
        assert self.process.wait(PATIENCE) != 0

    def kill_all(self) -> None:
        """kill -9 of snakemake and all its jobs."""
        os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait(PATIENCE)
        wait_for(lambda: not running(self.job))

    def go_on(self) -> int:
        """Let the job go on to the end; returns what snakemake returns."""
        (self.signs / "go").touch()
        return self.process.wait(PATIENCE)


def jobs_in(text: str) -> list[str]:
    """The jobs that snakemake names, sorted: their messages, of a figure its name alone; without the report of all."""
    messages = re.findall(r"^Job \d+: (.*)$", text, re.MULTILINE)
    counts = dict(re.findall(r"^(\w+) +(\d+)$", text, re.MULTILINE))
    assert counts or "Nothing to be done" in text
    silent = {"total", "all", "rough", "baseline", "smooth", "more", "accuracy_wave"}  # rules that only gather files
    assert len(messages) == sum(int(count) for name, count in counts.items() if name not in silent)
    messages = [message for message in messages if not message.startswith(REPORT)]
    return sorted(re.sub(r"^(fig_\w+): .*", r"\1", message) for message in messages)


def hear_ctrl_c() -> None:
    """End by Ctrl-C, which a process that a shell starts in the background does not hear, nor what it starts."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def wait_for(reached: Callable[[], bool]) -> None:
    """Wait until it is so."""
    end = time.monotonic() + PATIENCE
    while not reached():
        assert time.monotonic() < end, "waited too long"
        time.sleep(0.02)


def running(pid: int) -> bool:
    """Whether a process is there and alive."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] not in "ZX"
    except OSError:
        return False


def runs(planned: list[str]) -> list[str]:
    """The planned jobs that are runs."""
    return [message for message in planned if re.search(r": .*member \d", message)]


def apart(planned: list[str]) -> set[str]:
    """The planned jobs that are not runs."""
    return set(planned) - set(runs(planned))


def of_study(planned: list[str]) -> Counter:
    """How many runs are planned of each study."""
    return Counter(re.match(r"\w+", message)[0] for message in runs(planned))
