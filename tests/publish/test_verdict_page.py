"""The pages of verdicts show every statement, its numbers, its cause, and what changed it."""

from __future__ import annotations

import pandas as pd
import pytest

from contactsim.analysis.causes import UNKNOWN
from contactsim.analysis.claims import judge_claims
from contactsim.publish.open_questions import undecided_text, undetermined_text
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
    reading = "mean of κ<br><sub>`rough_line`: 4 members of 262144 points, 3 loads</sub>"
    cells = f"{reading} | 2 ± 0.1<br><sub>A test.</sub> | 2.051 ± none ± 0.011 | reproduced | 4.4 | 0.51 |"
    assert f"| κ is 2, a value that holds.<br><sub>Section 0 · `holds`</sub> | {cells}" in page
    block = page[page.index("**κ is 3.** Not reproduced (Section 0).") :]
    assert block.index("- Found 2.051 ± none ± 0.011, allowed 3 ± 0.1;") < block.index("- Estimator: Off by 0.3.")
    block = page[page.index("**κ is 4.** Not reproduced (Section 0).") :]
    assert f"- {UNKNOWN.capitalize()}." in block
    assert "**κ is 2, a value" not in page
    assert (
        "- Holds with 1 of the 2 readings that are decided.\n- By the reading of the claim itself: reproduced." in page
    )
    assert "| κ is open. | as judged |" in page
    assert page.index("## Chapter 3") < page.index("## Findings") < page.index("## What the text leaves open")


@pytest.mark.parametrize(
    ("place", "verdict", "told"),
    [
        (0.95, "reproduced", True),
        (1.08, "not reproduced", True),
        (0.5, "reproduced", False),
        (1.0, "not decidable", False),
    ],
)
def test_a_verdict_at_the_edge_of_its_band_says_so(verdicts, place, verdict, told):
    page = verdict_page(verdicts[verdicts.claim == "holds"].assign(place=place, verdict=verdict))
    assert (f"| {verdict}<br><sub>at the edge of the band</sub> |" in page) == told


def test_both_estimators_stand_side_by_side_with_their_verdicts(verdicts):
    beside = {"beside": "kappa_corrected", "beside_value": 2.3, "beside_ensemble_error": 0.0, "beside_grid_error": 0.01}
    row = verdicts.iloc[[0]].assign(**beside, beside_verdict="not reproduced", beside_margin=20.0)
    page = verdict_page(row)
    cells = "2.051 ± none ± 0.011 | reproduced (4.4) | 2.300 ± none ± 0.010 | not reproduced (20) | as in the thesis |"
    assert f"| κ is 2, a value that holds. | {cells}" in page
    assert "both estimators" not in verdict_page(verdicts)


def test_a_block_tells_its_condition_its_cases_and_other_bands(verdicts):
    condition = {"condition": "H = 0.2", "condition_share": 0.5, "condition_value": 2.95}
    errors = {"condition_ensemble_error": 0.01, "condition_grid_error": 0.02}
    cases = {"cases": "light: reproduced (2.9); heavy: not reproduced (2.1)", "deciding_case": "heavy"}
    row = verdicts[verdicts.claim == "fails"].assign(**condition, **errors, **cases, verdict_double="reproduced")
    page = verdict_page(row)
    assert "- Holds for H = 0.2 (50% of all): 2.950 ± 0.010 ± 0.020." in page
    assert "- Cases: light: reproduced (2.9); heavy: not reproduced (2.1).\n- The case that decides: heavy." in page
    assert "- With half the band; with double: not reproduced; reproduced." in page
    assert "mean of κ: heavy<br>" in page


def test_changes_are_listed_with_their_reasons(verdicts):
    earlier = {"holds": "reproduced", "fails": "reproduced", "gone": "not decidable"}
    before = pd.DataFrame(earlier.items(), columns=["claim", "verdict"]).assign(statement=[None, None, "κ is 5."])
    reasons = pd.DataFrame({"claim": ["fails", "fails"], "reason": ["band", "grid"]})
    page = changes_page(before, verdicts, reasons)
    assert "| κ is 3. | reproduced | not reproduced | 77 | band; grid |" in page
    assert "| κ is 5. | not decidable | – | – | reason not yet given |" in page
    assert "| κ is 4. | not reproduced | > 99 |\n" in page[page.index("## New") : page.index("## As before")]
    assert "| κ is 2, a value that holds. | reproduced |" in page.split("## As before")[1]


def test_what_all_cells_or_none_have_tells_nothing_about_the_cell():
    verdicts = {"all": "yyy", "none": "nnn", "first": "ynn", "last": "nny", "few": "?yn"}
    words = {"y": "reproduced", "n": "not reproduced", "?": "not decidable"}
    rows = [
        {
            "candidate": f"c{number}",
            "claim": claim,
            "verdict": words[mark],
            "width": 10.0**number,
            "thickness": 100.0 * number,
        }
        | {"lattice_constant": 2.0 + number**2, "admitted": True, "admitted_by_signs": True, "apart": True}
        for claim, marks in verdicts.items()
        for number, mark in enumerate(marks, start=1)
    ]
    text = undetermined_text(pd.DataFrame(rows))
    assert "Of the 5 statements that are decided in some of the 3 cells, 1 hold in all" in text
    assert "1 in none, so that they tell nothing about the cell; 3 hold in some" in text
    assert "at best 2 of 4 hold" in text
    assert "`first` and `last`" in text


WORDS = "κ < 3 & <b>more</b>\n\n# [here](http://x) | there"


def test_words_of_the_config_are_no_html_no_link_and_no_line_of_their_own(verdicts):
    texts = dict.fromkeys(("statement", "source", "rationale", "cause"), WORDS)
    claims = verdicts.assign(**texts)
    before = pd.DataFrame({"claim": ["holds"], "verdict": ["not reproduced"], "statement": [WORDS]})
    for page in (verdict_page(claims), changes_page(before, claims, pd.DataFrame({"claim": [], "reason": []}))):
        assert "κ &lt; 3 &amp; &lt;b>more&lt;/b> # \\[here](http://x) \\| there" in page
        assert "<b>" not in page and "\n# [" not in page and " [here]" not in page


def test_what_would_decide_is_counted():
    frame = pd.DataFrame({"claim": ["a", "b", "c"], "verdict": ["not decidable"] * 3, "chapter": "ch6"})
    text = "Of the 3 statements that are not decidable, 2 want more members or a finer grid, and 1 more onsets"
    assert text in next(undecided_text(frame.assign(decided_over=["", "approaches", ""])))
    assert list(undecided_text(frame.assign(verdict="reproduced"))) == []


def test_the_pages_in_docs_are_those_of_the_table():
    docs = ROOT / "docs"
    claims = pd.read_csv(docs / "gallery/verdicts.csv")
    before, reasons = (pd.read_csv(docs / f"verdict_{name}.csv") for name in ("before", "reasons"))
    assert (docs / "verdicts.md").read_text(encoding="utf-8") == verdict_page(claims)
    assert (docs / "verdict_changes.md").read_text(encoding="utf-8") == changes_page(before, claims, reasons)
