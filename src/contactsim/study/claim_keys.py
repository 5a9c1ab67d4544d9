"""Keys of a claim in the config: what each may be, and which of them cases, readings and numbers of causes replace."""

from __future__ import annotations

from contactsim.analysis.causes import KINDS
from contactsim.analysis.cell_rules import CELL
from contactsim.analysis.comparison import SECOND_STUDY
from contactsim.analysis.formulas import FORMULAS
from contactsim.analysis.reductions import ORDERS, REDUCTIONS, reduction_inputs
from contactsim.study.reading import Key, choice, listed, mapping, number, positive, text

GRIDS = ("thesis",)
"""Grids of a statement: the thesis's own number of points, on which a number has no grid error."""
WITHOUT_INPUTS = [name for name in REDUCTIONS if not reduction_inputs(name)]
"""Reductions that look at one quantity, value by value."""
CLAIM_KEYS = {
    "source": Key(text, "where the thesis says so"),
    "statement": Key(text, "what the thesis says"),
    "rationale": Key(text, "why that band, or why there is no answer"),
    "study": Key(text, "the name of a study of this chapter, or left out where there is no answer", None),
    "formula": Key(choice(FORMULAS), f"one of {', '.join(FORMULAS)}, or left out", None),
    "relative_to": Key(text, "the name of a second study that divides, or left out", None),
    "minus": Key(text, "the name of a second study that is subtracted, or left out", None),
    "departs_from": Key(text, "the name of a second study that curves are compared with, or left out", None),
    "more_members": Key(listed(text), "a list of studies with more members of the same surfaces on fewer points", None),
    "quantity": Key(text, "the name of a quantity", None),
    "beside": Key(text, "the name of a quantity that is judged beside it and not counted, or left out", None),
    "reduce": Key(choice((*REDUCTIONS, *ORDERS)), f"one of {', '.join((*REDUCTIONS, *ORDERS))}", None),
    "against": Key(text, "the name of a quantity", None),
    "along": Key(text, "a dimension of the study", None),
    "across": Key(text, "another dimension of the study", None),
    "select": Key(mapping, "a mapping from a dimension to its least and largest value", None),
    "expect": Key(number, "a number, with `tolerance`", None),
    "tolerance": Key(positive, "a positive number, with `expect`", None),
    "at_least": Key(number, "a number", None),
    "at_most": Key(number, "a number", None),
    "neutral": Key(number, "the value that the statement names, or that would mean no change", None),
    "absent": Key(text, "what a variant lacks that has no such number", None),
    "grid": Key(choice(GRIDS), f"one of {', '.join(GRIDS)}", None),
    "whole": Key(listed(text), "dimensions that a condition does not narrow", None),
    "case": Key(text, "the name of the claim's own case, with `cases`", None),
    "cases": Key(mapping, "a mapping from the name of a case to the keys that it replaces", None),
    "admissible": Key(mapping, "a mapping from what the text leaves open to its alternatives", None),
    "cause": Key(mapping, "a mapping with `kind`, `text`, and if needed `numbers` and `cell`", None),
}
CAUSE_KEYS = {
    "kind": Key(choice(KINDS), f"one of {', '.join(KINDS)}"),
    "text": Key(text, "a short text with the numbers that show it, each by its name in braces"),
    "numbers": Key(mapping, "a mapping from a name to the keys of the claim that it replaces", {}),
    "cell": Key(mapping, "what separates candidates: a mapping from lengths of the cell to their exponents", None),
}
CELL_KEYS = {name: Key(number, "an exponent", None) for name in CELL}
EDGES = ("at_least", "at_most")
"""Keys of a band with one edge; a band with two is `expect` with `tolerance`."""
REPLACED = (
    *("study", *SECOND_STUDY, "more_members", "quantity", "reduce", "along", "against", "select"),
    *("expect", "tolerance", *EDGES),
)
CASE_KEYS = {key: CLAIM_KEYS[key] for key in REPLACED}
"""Keys that a further case of a statement may replace."""
DATA_KEYS = ("study", *SECOND_STUDY, "more_members", "select")
MEASURE_KEYS = ("reduce", "along", "across", "against")
NUMBER_KEYS = {key: CLAIM_KEYS[key] for key in (*DATA_KEYS, "quantity", *MEASURE_KEYS, "absent")}
"""Keys that a number of a cause may replace: where the data come from, and what is done with them."""
CHOICE_KEYS = {key: CLAIM_KEYS[key] for key in (*REPLACED, "cases")}
"""Keys that an admissible alternative may replace."""
