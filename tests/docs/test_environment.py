"""Every package is pinned, has digests, and stands on the page of licences."""

from __future__ import annotations

import re

from support.places import ROOT


def pins(name):
    """Version of each package by its name as pip compares names."""
    text = (ROOT / name).read_text(encoding="utf-8")
    return {
        re.sub(r"[-_.]+", "-", name).lower(): version for name, version in re.findall(r"(?m)^([\w.-]+)==(\S+)", text)
    }


def test_the_lock_has_the_packages_of_the_environment_each_with_digests_and_nothing_else():
    assert pins("environment.lock.txt") == pins("environment.txt")
    assert len(pins("environment.txt")) > 90
    entries = re.split(r"\n(?=\S)", (ROOT / "environment.lock.txt").read_text(encoding="utf-8").rstrip())
    for entry in entries:
        assert re.fullmatch(r"[\w.-]+==[\w.]+( \\\n    --hash=sha256:[0-9a-f]{64})+", entry), entry[:80]


def test_setup_installs_nothing_without_a_digest():
    commands = [line for line in (ROOT / "Makefile").read_text(encoding="utf-8").splitlines() if "pip install" in line]
    assert len(commands) == 2
    assert "--require-hashes -r environment.lock.txt" in commands[0]
    assert "--no-deps --no-build-isolation -e ." in commands[1]


def test_the_page_of_licences_lists_every_package_with_its_version():
    rows = re.findall(
        r"(?m)^\| ([\w.-]+) \| (\S+) \| (.+) \|$", (ROOT / "docs/licences.md").read_text(encoding="utf-8")
    )
    listed = {re.sub(r"[-_.]+", "-", name).lower(): version for name, version, _ in rows if version != "version"}
    assert {name: version for name, version in listed.items() if version != "---"} == pins("environment.txt")
    assert all(licence.strip() for *_, licence in rows)
