"""Bundle: all results of a tier in one folder, ready to deposit.

It holds the files, a README.md written from the datasets, a list of the jobs behind the results, checksums, and an
RO-Crate, which describes the folder and the run in a form that archives read. Its only dates are those of the jobs, and
it names no place, so two bundles of the same results agree byte for byte. It appears under its name only when it is
complete; an older one is removed first.
"""

from __future__ import annotations

import hashlib
import json
import os
import shutil
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import pandas as pd
import xarray as xr

from contactsim import dataset
from contactsim.errors import InputError
from contactsim.provenance import digest
from contactsim.publish.markdown import plain_words, table
from contactsim.publish.ro_crate import CITATION, PROFILES, WORKFLOW, WorkflowRun, author_name, crate, read_citation

README, SUMS, METADATA, JOBS = "README.md", "SHA256SUMS", "ro-crate-metadata.json", "jobs.csv"
RESULTS = ("datasets", "costs", "figures", "claims", "report.html")
"""Files and folders that the workflow creates."""
REANALYSIS = "examples/reanalyse.py"
"""Example that analyses two studies of the thesis again."""

FILE_KINDS = {
    "datasets": "results, netCDF-4",
    "costs": "times and memory of every solution",
    "figures": "figure; csv: the numbers in it",
    "claims": "statements of the thesis, each with its verdict",
    "config": "the settings",
    "examples": "how to use the datasets without contactsim",
    WORKFLOW: "main file of the workflow that made the results",
    "workflow": "rules, scripts and modules of the workflow",
    JOBS: "jobs behind the results: rule, digest of settings and code, what each read, and when it ended",
    "report.html": "all figures and verdicts on one page",
    "environment.txt": "all packages, with their versions",
    "environment.lock.txt": "the same, with the digests of their files",
    CITATION: "citation",
    "LICENSE": "licence",
    README: "description of the folder",
    SUMS: "checksums of all other files",
    METADATA: "description of the folder, for machines",
}
"""Description of a file, or of the files of a folder."""

WITHOUT_VALUES = {
    "x": ("nm", "position along x: as many points as `points`, evenly over `length`, from 0"),
    "y": ("nm", "position along y: as many points as `points_y`, evenly over `length_y`, from 0"),
}
"""Unit and meaning of dimensions that a dataset may leave without a variable of their name."""


@dataclass(frozen=True)
class Contents:
    """Contents of a dataset: title, digest of settings, versions, sizes; dimensions, unit and meaning of variables."""

    title: str
    settings: str
    versions: dict[str, str]
    sizes: dict[str, int]
    dims: dict[str, tuple[str, ...]]
    words: dict[str, tuple[str, str]]

    @classmethod
    def of(cls, data: xr.Dataset) -> Contents:
        """Return the contents of a dataset."""
        dims = {str(name): tuple(map(str, item.dims)) for name, item in data.variables.items()}
        words = {str(name): _words(item) for name, item in data.variables.items()}
        settings, versions = digest(dataset.settings_of(data)), json.loads(data.attrs["versions"])
        return cls(data.attrs["title"], settings, versions, dict(data.sizes), dims, words)


def _words(item: xr.Variable) -> tuple[str, str]:
    """Return unit and meaning of a variable, with the meaning of each flag."""
    text = item.attrs["long_name"]
    flags = item.attrs.get("flag_values", item.attrs.get("flag_masks"))
    if flags is not None:
        pairs = zip(flags, item.attrs["flag_meanings"].split(), strict=True)
        text += ": " + ", ".join(f"{value} {meaning}" for value, meaning in pairs)
    return item.attrs["units"], text


def write_bundle(plan: Mapping, files: Mapping[str, str | Path], jobs: pd.DataFrame, target: str | Path) -> None:
    """Write a bundle; it appears under its name when it is complete.

    Parameters
    ----------
    plan : mapping
        Tier, titles by name of a dataset, figure or chapter, and digests of the code and settings of each dataset.
    files : mapping
        Present path of each file by its path in the bundle.
    jobs : DataFrame
        The jobs behind the results, as of `contactsim.publish.job_list`.
    target : path
        Folder to write.

    Raises
    ------
    InputError
        For a file that cannot be read.
    """
    target = Path(target)
    unfinished = target.with_name(f".{target.name}.tmp")
    shutil.rmtree(unfinished, ignore_errors=True)
    if target.exists():
        os.replace(target, unfinished)
        shutil.rmtree(unfinished)
    try:
        for place, path in files.items():
            _copy(Path(path), unfinished / place)
        _describe(plan, sorted(files), jobs, unfinished)
        os.replace(unfinished, target)
    finally:
        shutil.rmtree(unfinished, ignore_errors=True)


def _copy(path: Path, place: Path) -> None:
    """Copy a file into the bundle."""
    place.parent.mkdir(parents=True, exist_ok=True)
    try:
        shutil.copyfile(path, place)
    except OSError as error:
        raise InputError("bundle", path, f"a file that can be read ({error.strerror})") from error


def _describe(plan: Mapping, places: Sequence[str], jobs: pd.DataFrame, folder: Path) -> None:
    """Write README, list of jobs, metadata and checksums into a folder that has all other files."""
    citation = read_citation(folder / CITATION)
    contents = {place: Contents.of(dataset.load_dataset(folder / place)) for place in places if place.endswith(".nc")}
    about = {place: about_file(place, plan["titles"]) for place in [*places, README, JOBS, SUMS, METADATA]}
    (folder / README).write_text(readme(plan, citation, contents, about), encoding="utf-8")
    jobs.to_csv(folder / JOBS, index=False)
    sums = {place: _sum(folder / place) for place in [*places, README, JOBS]}
    listed = {place: {"description": text} for place, text in about.items() if place != METADATA}
    for place, value in sums.items():
        listed[place] |= {"sha256": value, "contentSize": str((folder / place).stat().st_size)}
    for place, item in contents.items():
        listed[place] |= {"variableMeasured": sorted(item.dims)}
    listed[README] |= {"about": {"@id": "./"}}
    run = WorkflowRun(
        tier=plan["tier"],
        settings=[place for place in places if Path(place).parts[0] == "config"],
        results=[place for place in places if Path(place).parts[0] in RESULTS],
        trace=JOBS,
        started=jobs.ended.min(),
        ended=jobs.ended.max(),
    )
    crate(citation, digest(plan), listed, run).metadata.write(folder)
    sums[METADATA] = _sum(folder / METADATA)
    (folder / SUMS).write_text("".join(f"{sums[place]}  {place}\n" for place in sorted(sums)), encoding="utf-8")


def _sum(path: Path) -> str:
    """Return the SHA-256 of a file."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def about_file(place: str, titles: Mapping[str, str]) -> str:
    """Return the description of a file: its title, if it has one, and its kind."""
    path = Path(place)
    title = titles.get(path.stem.removesuffix("_at_equal_error"))
    kind = FILE_KINDS[path.parts[0]]
    return f"{title} ({kind})" if title and len(path.parts) > 1 else kind


def readme(plan: Mapping, citation: Mapping, contents: Mapping[str, Contents], about: Mapping[str, str]) -> str:
    """Return the README.md of a bundle: how to check, cite and make it, and its datasets, variables and files."""
    tier, names = plan["tier"], ", ".join(map(author_name, citation["authors"]))
    packages = sorted({f"{name} {version}" for item in contents.values() for name, version in item.versions.items()})
    parts = [
        f"# {plain_words(citation['title'])}: results of the tier {tier}",
        f"By {names}; version {citation['version']}, {citation['date-released']}; licence {citation['license']}. "
        f"How to cite: `{CITATION}`. `{METADATA}` lists all files and the run that made them, for machines "
        f"({', '.join(PROFILES.values())}).",
        "## Check it",
        f"In this folder, `sha256sum -c --quiet {SUMS}` names every file that is not as it was, and no other.",
        "## Use it",
        "The datasets are netCDF-4, with a unit and a long name on every variable; xarray and every other reader of "
        f"netCDF opens them.{_reanalysis(about)}",
        "Lengths are in nm, moduli and pressures in GPa, loads of lines in N/m; a ratio has unit 1. A gap above zero "
        "is open, a normal traction above zero pulls, a load above zero presses.",
        "## Make it again",
        f"In a copy of contactsim {citation['version']}, with `config/` and `environment.txt` as they are here:",
        f"```sh\nmake bundle TIER={tier}\n```",
        "Datasets then come out byte for byte the same, at one number of threads; `costs/` holds times, which do not, "
        "and names the single runs, which are not here. The digest of code and settings is "
        f"`{digest(plan)}`; that of each dataset stands with it. Made with {', '.join(packages)}. `{JOBS}` lists the "
        "jobs: what each made and read, and when it ended.",
        "## Datasets",
        *(_dataset(place, item, plan["data"][Path(place).stem]) for place, item in sorted(contents.items())),
        "## Dimensions",
        table(("dimension", "unit", "meaning"), _dimensions(contents.values())),
        "## Variables",
        table(("variable", "unit", "meaning"), _variables(contents.values())),
        "## Files",
        table(("file", "what it is"), [(f"`{place}`", plain_words(text)) for place, text in sorted(about.items())]),
    ]
    return "\n\n".join(part.rstrip("\n") for part in parts) + "\n"


def _reanalysis(places: Iterable[str]) -> str:
    """Return a sentence on the example, with a space before it; empty if it is not in the bundle."""
    if REANALYSIS not in places:
        return ""
    return (
        f" `python {REANALYSIS} .` counts contact by another definition and fits another law, with numpy and xarray "
        "alone."
    )


def _dataset(place: str, contents: Contents, code_digest: str) -> str:
    """Return the section of a dataset: title, digests, sizes, and variables by their dimensions."""
    by_dims: dict[tuple[str, ...], list[str]] = {}
    for name, dims in contents.dims.items():
        by_dims.setdefault(dims, []).append(f"`{name}`")
    rows = [(", ".join(dims) or "–", ", ".join(names)) for dims, names in sorted(by_dims.items())]
    sizes = ", ".join(f"{name} {count}" for name, count in contents.sizes.items())
    digests = f"Code and settings: `{code_digest}`; settings alone: `{contents.settings}`"
    words = f"{plain_words(contents.title)}. {digests}. Sizes: {sizes}."
    return f"### `{place}`\n\n{words}\n\n{table(('dimensions', 'variables'), rows)}"


def _dimensions(contents: Iterable[Contents]) -> list[tuple[str, ...]]:
    """Return each dimension with unit and meaning."""
    defaults = WITHOUT_VALUES | {"": ("1", "number")}
    rows = {(name, *item.words.get(name, defaults.get(name, defaults[""]))) for item in contents for name in item.sizes}
    return [(f"`{name}`", *words) for name, *words in sorted(rows)]


def _variables(contents: Iterable[Contents]) -> list[tuple[str, ...]]:
    """Return each variable with unit and meaning; several rows if datasets differ in it."""
    rows = {(name, *words) for item in contents for name, words in item.words.items()}
    return [(f"`{name}`", *words) for name, *words in sorted(rows)]
