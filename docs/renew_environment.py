"""Make environment.lock.txt and docs/licences.md again from environment.txt.

Needs the package `uv`, which finds the digests, and all packages of environment.txt, whose licences are read. `make
setup` installs those first if only their versions are edited: run this, `make setup`, and this again.
"""

import re
import subprocess
from collections.abc import Iterator
from importlib import metadata
from pathlib import Path

ROOT = Path(__file__).parent.parent
PINS, LOCK, LICENCES = ROOT / "environment.txt", ROOT / "environment.lock.txt", ROOT / "docs/licences.md"
OLDEST_PYTHON = "3.11"
HEAD = """# Licences

Packages of [environment.txt](../environment.txt), each with the licence that it states of itself. contactsim has its
own, [MIT](../LICENSE), and contains none of these packages. The page of the report contains two scripts, Panzoom (MIT)
and sortable (Unlicense), with [their licences](../src/contactsim/publish/page/vendor/LICENSES.txt).
`python docs/renew_environment.py` makes this page again.

| package | version | licence |
|---|---|---|
"""
EXPRESSIONS = {
    "Apache Software License": "Apache-2.0",
    "BSD License": "BSD",
    "GNU Lesser General Public License v2 or later (LGPLv2+)": "LGPL-2.0-or-later",
    "GNU Lesser General Public License v3 or later (LGPLv3+)": "LGPL-3.0-or-later",
    "GNU General Public License v2 or later (GPLv2+)": "GPL-2.0-or-later",
    "MIT License": "MIT",
    "Mozilla Public License 2.0 (MPL 2.0)": "MPL-2.0",
    "Python Software Foundation License": "PSF-2.0",
}
"""Short names of licences that packages state in words."""


def pinned_packages() -> Iterator[tuple[str, str]]:
    """Yield name and version of each package."""
    yield from re.findall(r"^([\w.-]+)==(\S+)$", PINS.read_text(encoding="utf-8"), re.MULTILINE)


def licence(name: str) -> str:
    """Return the licence of an installed package as it states it: in short, as a class, or in its first words."""
    package = metadata.metadata(name)
    if "License-Expression" in package:
        return package["License-Expression"]
    classes = [line.rpartition(" :: ")[2] for line in package.get_all("Classifier") or () if line.startswith("License")]
    classes = [EXPRESSIONS.get(line, line) for line in classes if line != "OSI Approved"]
    words = " ".join((package.get("License") or "").split())
    return " and ".join(classes) if classes else words if 0 < len(words) < 60 else "see its files"


def lock_environment() -> None:
    """Write the digests of every file of each package, for all platforms."""
    options = ["--generate-hashes", "--no-deps", "--no-annotate", "--no-header", "--no-emit-package", "contactsim"]
    command = [
        "uv",
        "pip",
        "compile",
        "--quiet",
        *options,
        "--python-version",
        OLDEST_PYTHON,
        PINS.name,
        "-o",
        LOCK.name,
    ]
    LOCK.unlink(missing_ok=True)
    subprocess.run(command, cwd=ROOT, check=True)


def licence_page() -> str:
    """Return the page of licences, with the packages in the order of their names."""
    rows = sorted(pinned_packages(), key=lambda row: row[0].lower())
    return HEAD + "".join(f"| {name} | {version} | {licence(name)} |\n" for name, version in rows)


if __name__ == "__main__":
    lock_environment()
    LICENCES.write_text(licence_page(), encoding="utf-8")
