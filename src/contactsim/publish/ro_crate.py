"""An RO-Crate: the contents of a folder of results in the form that archives read.

Title, authors, licence and date are those of the CITATION.cff, never of the day on which the folder is made. The crate
lists files by their place in the folder; it does not copy them.
"""

from __future__ import annotations

from collections.abc import Mapping
from datetime import date
from pathlib import Path

from rocrate.model.contextentity import ContextEntity
from rocrate.rocrate import ROCrate

from contactsim.errors import InputError
from contactsim.study.plain_yaml import load_yaml

CITATION = "CITATION.cff"
RO_CRATE = "1.2"
"""Version of the RO-Crate."""
LICENCES = "https://spdx.org/licenses/"

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


def crate(citation: Mapping, part: str, identifier: str, files: Mapping[str, Mapping[str, object]]) -> ROCrate:
    """Return the RO-Crate of a folder of results.

    citation: of `read_citation`; part: which of all results these are; files: properties of each by its place.
    """
    archive = ROCrate(version=RO_CRATE)

    def entity(key: str, kind: str, **properties: object) -> ContextEntity:
        """Add an entity that is no file, and return it."""
        return archive.add(ContextEntity(archive, key, {"@type": kind, **properties}))

    people = [
        entity(_id(author, number), "Organization" if "name" in author else "Person", name=author_name(author))
        for number, author in enumerate(citation["authors"], 1)
    ]
    root, licence = archive.root_dataset, citation["license"]
    for key, value in {
        "name": f"{citation['title']}: results, {part}",
        "description": "Datasets, costs, figures and verdicts, with the settings that they were made from.",
        "datePublished": citation["date-released"],
        "version": str(citation["version"]),
        "identifier": identifier,
        "author": people if len(people) > 1 else people[0],
        "license": entity(LICENCES + licence, "CreativeWork", name=licence, description="Its text is in LICENSE."),
    }.items():
        root[key] = value
    for place, properties in sorted(files.items()):
        form = FORMATS.get(Path(place).suffix, "text/plain")
        archive.add_file(dest_path=place, properties={"name": Path(place).name, "encodingFormat": form, **properties})
    return archive


def _id(author: Mapping, number: int) -> str:
    """Return the identifier of an author."""
    return author.get("orcid") or f"#author-{number}"
