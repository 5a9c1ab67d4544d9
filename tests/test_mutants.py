"""Mutants of the benchmarks: each can still be put into the package, and its own tests are there."""

from __future__ import annotations

import sys

from support.places import ROOT

sys.path.insert(0, str(ROOT / "benchmarks"))

import mutants


def test_each_mutant_fits_its_file_and_names_tests_that_there_are():
    table = mutants.read_mutants([])  # raises where the text of one does not stand once in its file
    assert len(table) > 180
    for test in (test for mutant in table for test in mutant.tests):
        file, _, name = test.partition("::")
        code = (ROOT / "tests" / file).read_text(encoding="utf-8") if file.endswith(".py") else ""
        assert not name or f"def {name.partition('[')[0]}(" in code, test
        assert (ROOT / "tests" / file).exists(), test
