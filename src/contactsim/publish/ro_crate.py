"""An RO-Crate: the contents of a folder of results and the run that made them, in the form that archives read.

Title, authors, licence and date are those of the CITATION.cff, never of the day on which the folder is made. The crate
lists files by their place in the folder; it does not copy them. It is a Workflow Run Crate: the main file of the
workflow was run with the settings of the folder, and created its results.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import date
from importlib import metadata
from pathlib import Path

from rocrate.model.contextentity import ContextEntity
from rocrate.model.entity import Entity
from rocrate.rocrate import ROCrate

from contactsim.errors import InputError
from contactsim.study.plain_yaml import load_yaml

CITATION = "CITATION.cff"
RO_CRATE = "1.1"
"""Version of the RO-Crate: the one that the profiles build on."""
PROFILES = {
    "https://w3id.org/ro/wfrun/process/0.5": "Process Run Crate",
    "https://w3id.org/ro/wfrun/workflow/0.5": "Workflow Run Crate",
    "https://w3id.org/workflowhub/workflow-ro-crate/1.0": "Workflow RO-Crate",
}
"""Profiles that the crate has, by their addresses, which end in their versions."""
OWN_TERMS = {"sha256": "http://schema.org/sha256"}
"""Terms that RO-Crate 1.1 lacks."""
LICENCES = "https://spdx.org/licenses/"
WORKFLOW = "Snakefile"
"""Main file of the workflow."""

FORMATS = {
    ".nc": "application/x-netcdf",
    ".csv": "text/csv",
    ".png": "image/png",
    ".svg": "image/svg+xml",
    ".gif": "image/gif",
    ".pdf": "application/pdf",
    ".html": "text/html",
    ".md": "text/markdown",
    ".py": "text/x-python",
    ".yaml": "application/yaml",
    ".cff": "application/yaml",
}
"""Media type by ending; the rest is plain text."""


def read_citation(file: Path) -> dict:
    """Return the content of a CITATION.cff; InputError if it lacks what a crate needs."""
    citation = load_yaml(file)
    for key in ("title", "authors", "license", "version", "date-released"):
        if not citation.get(key):
            raise InputError(key, citation.get(key), "given, as it is part of what is deposited", file)
    try:
        day = date.fromisoformat(str(citation["date-released"]))
    except ValueError as error:
        raise InputError("date-released", citation["date-released"], "a date as 2019-10-31", file) from error
    return citation | {"date-released": day.isoformat()}


def author_name(author: Mapping) -> str:
    """Return the name of an author of a CITATION.cff."""
    parts = (author.get("given-names"), author.get("name-particle"), author.get("family-names"))
    return author.get("name") or " ".join(part for part in parts if part)


@dataclass(frozen=True)
class WorkflowRun:
    """The run of the workflow that made the results.

    Parameters
    ----------
    tier : str
        The tier that was made.
    settings, results : sequence of str
        Places of the files that the run read and of those that it created.
    trace : str
        Place of the list of its jobs.
    started, ended : str
        When the first and the last of its jobs ended, in ISO 8601.
    """

    tier: str
    settings: Sequence[str]
    results: Sequence[str]
    trace: str
    started: str
    ended: str


def crate(citation: Mapping, identifier: str, files: Mapping[str, Mapping[str, object]], run: WorkflowRun) -> ROCrate:
    """Return the RO-Crate of a folder of results.

    Parameters
    ----------
    citation : mapping
        As of `read_citation`.
    identifier : str
        Digest of what the results depend on.
    files : mapping
        Properties of each file by its place; the main file of the workflow is among them.
    run : WorkflowRun
        The run that made the results.
    """
    archive = ROCrate(version=RO_CRATE)
    archive.metadata.extra_terms.update(OWN_TERMS)
    people = [
        _add_entity(
            archive, _id(author, number), "Organization" if "name" in author else "Person", name=author_name(author)
        )
        for number, author in enumerate(citation["authors"], 1)
    ]
    licence = citation["license"]
    shared = {
        "version": str(citation["version"]),
        "author": people if len(people) > 1 else people[0],
        "license": _add_entity(
            archive, LICENCES + licence, "CreativeWork", name=licence, description="Its text is in the file LICENSE."
        ),
    }
    _set(
        archive.root_dataset,
        name=f"{citation['title']}: results, tier {run.tier}",
        description="Datasets, costs, figures and verdicts, with the settings that they were made from.",
        datePublished=citation["date-released"],
        identifier=identifier,
        conformsTo=[
            _add_entity(archive, profile, "CreativeWork", name=name, version=profile.rpartition("/")[2])
            for profile, name in PROFILES.items()
        ],
        **shared,
    )
    for place, properties in sorted(files.items()):
        if place == WORKFLOW:
            address = citation.get("repository-code") or citation.get("url")
            _add_workflow(archive, {**properties, **shared, **({"url": address} if address else {})})
        else:
            form = FORMATS.get(Path(place).suffix, "text/plain")
            named = {"name": Path(place).name, "encodingFormat": form, **properties}
            archive.add_file(dest_path=place, properties=named)
    _add_run(archive, f"#run-{identifier}", run, shared["author"])
    return archive


def _add_entity(archive: ROCrate, key: str, kind: str, **properties: object) -> ContextEntity:
    """Add an entity that is no file to an archive, and return it."""
    return archive.add(ContextEntity(archive, key, {"@type": kind, **properties}))


def _set(entity: Entity, **properties: object) -> None:
    """Set properties of an entity."""
    for key, value in properties.items():
        entity[key] = value


def _add_workflow(archive: ROCrate, properties: Mapping[str, object]) -> None:
    """Add the workflow: its main file, language and parameter."""
    workflow = archive.add_workflow(
        dest_path=WORKFLOW,
        properties={**properties, "name": "Workflow of contactsim", "encodingFormat": "text/plain"},
        main=True,
        lang="snakemake",
        lang_version=metadata.version("snakemake"),
    )
    workflow["input"] = _add_entity(
        archive, "#tier", "FormalParameter", name="tier", additionalType="Text", description="Sizes of all studies."
    )


def _add_run(archive: ROCrate, key: str, run: WorkflowRun, agent: object) -> None:
    """Add the run of the workflow: what it read and created, and when."""
    tier = _add_entity(archive, "#tier-made", "PropertyValue", name="tier", value=run.tier)
    tier["exampleOfWork"] = archive.get("#tier")
    archive.get("#tier")["workExample"] = tier
    action = archive.add_action(
        archive.mainEntity,
        key,
        object=[tier, *map(archive.get, run.settings)],
        result=[archive.get(place) for place in run.results],
        properties={
            "name": f"Results of the tier {run.tier}",
            "description": f"make bundle TIER={run.tier}. The start is when the first job ended: {run.trace} lists the "
            "jobs with the times at which they ended.",
            "startTime": run.started,
            "endTime": run.ended,
            "actionStatus": "http://schema.org/CompletedActionStatus",
        },
    )
    action["agent"] = agent
    archive.root_dataset["mentions"] = action
    archive.get(run.trace)["about"] = action


def _id(author: Mapping, number: int) -> str:
    """Return the identifier of an author."""
    return author.get("orcid") or f"#author-{number}"
