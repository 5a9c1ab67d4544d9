"""Settings of the identification: candidates, their runs, what admits them, and the statements that are judged."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from contactsim.analysis.comparison import SECOND_STUDY
from contactsim.errors import InputError
from contactsim.evaluation.figure_settings import FIGURE_KEYS, FigureSettings
from contactsim.evaluation.identification.admission import Limits
from contactsim.evaluation.identification.sampling import (
    Candidate,
    CandidateRanges,
    draw_candidates,
    drawn_name,
    has_cell,
    named_candidates,
)
from contactsim.evaluation.identification.simulation import CandidateJob, RunSettings
from contactsim.grid import MAX_POINTS
from contactsim.provenance import digest
from contactsim.solvers.registry import solver_module
from contactsim.study.plain_yaml import load_yaml
from contactsim.study.plan import Plan, boolean
from contactsim.study.reading import (
    SAFE_NAME,
    SAFE_NAME_FORM,
    Key,
    choice,
    interval,
    keys_of,
    listed,
    mapping,
    positive,
    read,
    text,
    whole,
)
from contactsim.study.stages import computing_stage_digest, stage_digest
from contactsim.study.tier_overrides import tiered

NAME = "identification"
POSITIVE = "a positive number"


def positive_interval(value: object) -> list[float]:
    """Return two positive numbers, the smaller one first."""
    return [positive(entry) for entry in interval(value)]


KEYS = FIGURE_KEYS | {
    "chapter": Key(text, "the name of a chapter"),
    "seed": Key(whole(0), "a whole number, 0 or more"),
    "candidates": Key(whole(1, 10_000), "how many are drawn"),
    "ranges": Key(mapping, "a mapping from a length to its range"),
    "named": Key(mapping, "a mapping from names to studies whose cells are judged too"),
    "interfaces": Key(listed(text), "a list of studies of the chapter, the strong interface first"),
    "not_judged": Key(listed(text), "a list of claims"),
    "runs": Key(mapping, "a mapping"),
    "admit": Key(mapping, "a mapping from a criterion to its limit"),
    "from_package": Key(boolean, "true or false"),
}
RANGE_KEYS = dict.fromkeys(
    ("width", "thickness_ratio", "lattice_constant"),
    Key(positive_interval, "a pair of positive numbers, the least and the largest"),
)
RUN_KEYS = {
    "approaches": keys_of(RunSettings)["approaches"],
    "points": Key(whole(1), "a whole number, 1 or more"),
    "slips": Key(whole(1), "a whole number, 1 or more"),
    **dict.fromkeys(("spacing", "increment", "fold_width", "tolerance", "flow_step"), Key(positive, POSITIVE)),
}


@dataclass(frozen=True)
class Identification(FigureSettings):
    """Candidates for the cell of the probe, their runs, and what admits them.

    Parameters
    ----------
    chapter
        Chapter whose statements are judged.
    named
        Candidates that are the cells of studies.
    drawn, draw_seed, ranges
        Number of the candidates that are drawn, the seed of their draw, and their ranges.
    sections
        Section of each interface by its name, the strong one first.
    claims
        Settings of each claim that is judged, by name.
    runs, limits
        Grid and increments, and what admits a candidate.
    seed
        Seed of the studies.
    from_package
        True where verdicts and figure take the candidates that the package holds.
    """

    chapter: str
    named: Sequence[Candidate]
    drawn: int
    draw_seed: int
    ranges: CandidateRanges
    sections: Mapping[str, dict]
    claims: Mapping[str, dict]
    runs: RunSettings
    limits: Limits
    seed: int
    from_package: bool

    @property
    def names(self) -> list[str]:
        """Names of all candidates."""
        return [candidate.name for candidate in self.named] + [drawn_name(number + 1) for number in range(self.drawn)]

    @cached_property
    def candidates(self) -> list[Candidate]:
        """The cells of studies, then those that are drawn."""
        return [*self.named, *draw_candidates(self.draw_seed, self.drawn, self.ranges)]

    def job(self, name: str, tier: str) -> CandidateJob:
        """Return the job of a candidate."""
        candidate = next(entry for entry in self.candidates if entry.name == name)
        return CandidateJob(candidate, self.sections, self.runs, self.seed, tier)


def read_identification(folder: str | Path, plan: Plan) -> Identification | None:
    """Return the settings of identification.yaml with a tier's changes; None without that file."""
    source = tiered(Path(folder) / f"{NAME}.yaml", plan.overrides[NAME], plan.tier)
    if source is None:
        return None
    section, file = source
    settings: dict[str, Any] = read(section, KEYS, file)
    chapter = settings["chapter"]
    own = [name for name, other in plan.chapters.items() if other == chapter]
    if not own:
        raise InputError("chapter", chapter, f"one of {', '.join(dict.fromkeys(plan.chapters.values()))}", file)
    studies = load_yaml(Path(folder) / f"{chapter}.yaml")["studies"]
    for name in settings["interfaces"]:
        if name not in own:
            raise InputError("interfaces", name, f"some of {', '.join(own)}", file)
    for name in settings["named"]:
        if not SAFE_NAME.fullmatch(name):
            raise InputError("named", name, SAFE_NAME_FORM, file)
    cells = [name for name in own if has_cell(studies[name])]
    cell = Key(choice(tuple(cells)), f"one of {', '.join(cells)}")
    settings["named"] = read(settings["named"], dict.fromkeys(settings["named"], cell), file, "named")
    ranges = CandidateRanges(**read(settings["ranges"], RANGE_KEYS, file, "ranges"))
    claims = {name: claim.settings for name, claim in plan.claims.get(chapter, {}).items()}
    return Identification(
        **{key: settings[key] for key in (*FIGURE_KEYS, "chapter", "from_package")},
        named=named_candidates(settings["named"], studies),
        drawn=settings["candidates"],
        draw_seed=settings["seed"],
        ranges=ranges,
        sections={name: studies[name] for name in settings["interfaces"]},
        claims=claims_on(claims, settings["interfaces"], settings["not_judged"]),
        runs=_read_runs(settings["runs"], ranges.width[1], file),
        limits=Limits(**read(settings["admit"], keys_of(Limits), file, "admit")),
        seed=plan.seed,
    )


def _read_runs(section: dict, width: float, file: object) -> RunSettings:
    """Return grid and increments of the candidates, the widest of which has a width in nm."""
    runs = RunSettings(**read(section, RUN_KEYS, file, "runs"))
    if runs.grid(width) > MAX_POINTS:
        raise InputError("runs.spacing", runs.spacing, f"at least {width / MAX_POINTS:g} nm", file)
    return runs


def claims_on(claims: Mapping[str, dict], studies: Sequence[str], left_out: Sequence[str]) -> dict[str, dict]:
    """Return the claims that read some studies and no others, without their admissible readings.

    claims: settings by name; left_out: claims that are not judged
    """
    judged = {}
    for name, claim in claims.items():
        cases = [claim, *(claim.get("cases") or {}).values()]
        read_studies = {case[key] for case in cases for key in ("study", *SECOND_STUDY)} - {None}
        if read_studies and read_studies <= set(studies) and not claim["is_finding"] and name not in left_out:
            judged[name] = {**claim, "admissible": None}
    return judged


def candidate_job(settings: Identification, name: str, tier: str) -> dict[str, Any]:
    """Return what the datasets of a candidate depend on."""
    source = computing_stage_digest("candidate", solver_module("newton"))
    return settings.job(name, tier).settings | {"source": source}


def judgement_job(settings: Identification, tier: str) -> dict[str, Any]:
    """Return what the verdicts in all candidates depend on: claims in their order, limits, and the candidates' data."""
    jobs = [candidate_job(settings, candidate.name, tier) for candidate in settings.candidates]
    return {
        "candidates": [asdict(candidate) for candidate in settings.candidates],
        "interfaces": list(settings.sections),
        "claims": [[name, claim] for name, claim in settings.claims.items()],
        "limits": asdict(settings.limits),
        "source": stage_digest("judge_candidates"),
        "data": digest(jobs),
    }


def figure_job(settings: Identification, tier: str) -> dict[str, Any]:
    """Return what the figure depends on beside the table of candidates."""
    return {
        "settings": settings.layout,
        "tier": tier,
        "source": stage_digest("identification_figure"),
    }
