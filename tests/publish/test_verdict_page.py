"""The pages of verdicts show every statement, its numbers, its cause, and what changed it."""

from __future__ import annotations

import pandas as pd
import pytest

from contactsim.analysis.causes import UNKNOWN
from contactsim.analysis.claims import judge_claims
from contactsim.publish.verdict_page import changes_page, verdict_page
from contactsim.study.claim_plan import read_claim
from support.claims import STUDIES, VALUE, claim, made_up, with_corrected
from support.places import ROOT

CAUSE = {"kind": "estimator", "text": "Off by 0.3."}
OPEN = {"weights": {"corrected": {"quantity": "kappa_corrected"}}}


@pytest.fixture
def verdicts():
    section = {name: entry for name, entry in VALUE.items() if name not in ("expect", "tolerance")}
    finding = read_claim("extra", section | {"statement": "κ of ours."}, "ch3.yaml", STUDIES, "findings").settings
    claims = {
        "holds": claim(statement="κ is 2, a value that holds."),
        "fails": claim(expect=3.0, statement="κ is 3.", cause=CAUSE),
        "puzzles": claim(expect=4.0, statement="κ is 4."),
        "depends": claim(statement="κ is open.", admissible=OPEN),
        "extra": finding,
    }
    data = with_corrected(made_up(2.0512, grid=0.011), 2.3, change=0.01, subgrid=2.3)
    return judge_claims(claims, {"rough_line": data}).assign(chapter="ch3")


def test_each_statement_stands_with_its_number_and_failures_with_their_cause(verdicts):
    page = verdict_page(verdicts)
    assert "| κ is 2, a value that holds. | mean of κ | 2 ± 0.1 | 2.051 ± 0 ± 0.011 | reproduced | 4.4 | 0.51 |" in page
    assert "**κ is 3.** Not reproduced. Estimator: Off by 0.3." in page
    assert f"**κ is 4.** Not reproduced. {UNKNOWN.capitalize()}." in page
    assert "**κ is 2, a value" not in page
    assert "holds with 50% of 2 decided readings; as judged: reproduced" in page
    assert page.index("## Chapter 3") < page.index("## Findings") < page.index("## What the text leaves open")


def test_changes_are_listed_with_their_reasons(verdicts):
    earlier = {"holds": "reproduced", "fails": "reproduced", "gone": "not decidable"}
    before = pd.DataFrame(earlier.items(), columns=["claim", "verdict"])
    reasons = pd.DataFrame({"claim": ["fails", "fails"], "reason": ["band", "grid"]})
    page = changes_page(before, verdicts, reasons)
    assert "| fails | reproduced | not reproduced | band; grid |" in page
    assert "| gone | not decidable | – | reason not yet given |" in page
    assert "| puzzles | not reproduced |\n" in page[page.index("## New") : page.index("## As before")]
    assert "| holds | reproduced |" in page.split("## As before")[1]


def test_the_pages_in_docs_are_those_of_the_table():
    docs = ROOT / "docs"
    claims = pd.read_csv(docs / "gallery/verdicts.csv")
    before, reasons = (pd.read_csv(docs / f"verdict_{name}.csv") for name in ("before", "reasons"))
    assert (docs / "verdicts.md").read_text(encoding="utf-8") == verdict_page(claims)
    assert (docs / "verdict_changes.md").read_text(encoding="utf-8") == changes_page(before, claims, reasons)
