"""How solvers stand up to hazards: every case judged, and the map of outcomes.

A solver's outcome on a case is right, certified (the residual is met, no exact answer is known), refused with a reason
or an honest failure. An answer that is wrong or not finite must not occur. Nothing of the solver's own certificate is
trusted: the gap is recomputed in physical units by another route.
"""

from __future__ import annotations

import logging
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np
import xarray as xr

from contactsim import dataset
from contactsim.api import press
from contactsim.config import Key, choice, keys_of, listed, mapping, number, read, size, text
from contactsim.errors import SceneError
from contactsim.hazards import HAZARDS, first_line
from contactsim.hazards.cases import Case, displacement, mirrored
from contactsim.provenance import digest, source_digest, versions
from contactsim.solvers import SOLVERS, module_of, solver, solver_class
from contactsim.solvers.base import Result, Solver, Status
from contactsim.traits import Trait

logger = logging.getLogger(__name__)


class Outcome(Enum):
    """What came of a case; the number is stored, the sentence explains it."""

    RIGHT = (0, "right: the exact answer is met")
    CERTIFIED = (1, "certified: the residual is met, no exact answer is known")
    REFUSED = (2, "refused, with a reason")
    FAILED = (3, "honest failure: the status says so")
    WRONG = (4, "wrong")
    NON_FINITE = (5, "not finite")


@dataclass(frozen=True)
class Verdict:
    """Outcome of one solver on one case, the work it took, and the reason of anything but success."""

    outcome: Outcome
    transforms: float
    reason: str = ""


def judge(case: Case, method: str | Solver) -> Verdict:
    """Press a case with a solver, and check all that can be checked independently of the solver."""
    try:
        result = press(
            case.heights,
            spacing=case.spacing,
            contact_modulus=case.contact_modulus,
            mean_pressure=case.mean_pressure,
            approach=case.approach,
            thickness=case.thickness,
            poisson_ratio=case.poisson_ratio,
            tolerance=case.tolerance,
            solver=method,
        )
    except SceneError as error:
        return Verdict(Outcome.REFUSED, 0.0, str(error))
    spent = result.record.transforms
    finite = all(np.isfinite(part).all() for part in (result.pressure, result.gap, result.approach))
    if not finite or result.status is Status.NON_FINITE:
        return Verdict(Outcome.NON_FINITE, spent, result.status.sentence)
    if result.status is not Status.CONVERGED:
        return Verdict(Outcome.FAILED, spent, result.status.sentence)
    fault = "answered what it should have refused" if case.refuse else faults(case, result)
    if fault:
        return Verdict(Outcome.WRONG, spent, fault)
    known = case.exact is not None or case.area is not None
    return Verdict(Outcome.RIGHT if known else Outcome.CERTIFIED, spent)


def faults(case: Case, result: Result) -> str:
    """What is wrong with a converged result; empty if nothing is."""
    allowed, pressure = _allowed(case, result), result.pressure
    sunk = case.compliance.flat[0] * result.mean_pressure
    gap = displacement(pressure, case.compliance) - case.heights
    level = gap[result.contact].mean() if sunk else result.approach
    gap -= level
    if abs(level + sunk - result.approach) > allowed + 1e-14 * sunk:
        return "approach and mean displacement do not fit the gap"
    if pressure.min() < 0:
        return "negative pressure"
    if case.approach is not None and abs(result.approach - case.approach) > allowed + 1e-14 * sunk:
        return "not the approach asked for"
    if case.approach is None and abs(result.mean_pressure - case.mean_pressure) > 1e-12 * case.mean_pressure:
        return "forces do not balance"
    if np.abs(gap[result.contact]).max(initial=0.0) > allowed or gap.min() < -allowed:
        return "contact condition violated"
    if case.mean_pressure == 0 and (result.record.iterations or abs(gap.min()) > allowed):
        return "no load, but iterations or no touch"
    precision = _precision(case, result.mean_pressure, allowed)
    if case.exact is not None and _rms(pressure - case.exact) > precision:
        return f"pressure off the exact one by {_rms(pressure - case.exact):.3g} rms, allowed {precision:.3g}"
    if case.area is not None and abs(result.relative_contact_area - case.area) > 1.5 / pressure.size:
        return f"contact area {result.relative_contact_area:.6g}, exact {case.area:.6g}"
    if case.mirror is not None and _rms(pressure - mirrored(pressure, case.mirror)) > 2 * precision:
        return "not mirror symmetric"
    return ""


def _allowed(case: Case, result: Result) -> float:
    """How far a gap may be off: twice the tolerance, and the rounding of heights and of the displacement."""
    highest = np.abs(case.heights).max() or 1.0
    scaled = case.heights / highest
    step = highest * _rms(np.stack([np.roll(scaled, -1, axis) - scaled for axis in range(scaled.ndim)]))
    step = step or (case.mean_pressure or 1.0) * case.spacings[-1] / case.contact_modulus
    reach = result.mean_pressure * (np.array(case.heights.shape) * case.spacings).max() / case.contact_modulus
    return 2 * case.tolerance * step + 1e-14 * (highest + reach)


def _precision(case: Case, load: float, allowed: float) -> float:
    """Largest rms error of the pressure, of any field that meets the contact condition to within `allowed`.

    At equal load, δp·S δp is at most the sum of both loads times the largest error of the gap, and S is at least its
    value for the stiffest wave. Where that says little, because a grid step is large beside what the load moves, a
    hundredth of the exact pressure is the most. With the approach prescribed there is no such bound: a thousandth of
    the load.
    """
    if case.mean_pressure is None:
        return 1e-3 * load
    bound = float(np.sqrt(2 * allowed * load / case.compliance.flat[1:].min())) + 1e-12 * load
    return bound if case.exact is None else min(bound, 1e-2 * _rms(case.exact))


def _rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2)))


def _severities(value: object) -> list[float]:
    """Numbers from 0 to 100, rising."""
    found = listed(number)(value)
    if found != sorted(found) or found[0] < 0 or found[-1] > 100:
        raise ValueError
    return found


STABILITY_KEYS = {
    "title": Key(text, "a line of text"),
    "caption": Key(text, "text"),
    "size": Key(size, "width and height in inches"),
    "severities": Key(_severities, "a rising list of numbers from 0 to 100"),
    "solvers": Key(mapping, f"a mapping from solvers, of {', '.join(SOLVERS)}, to their options"),
    "hazards": Key(listed(choice(HAZARDS)), f"a list from {', '.join(HAZARDS)}", list(HAZARDS)),
}


def read_settings(section: object, file: object) -> dict:
    """Check the settings of the map, down to the options of every solver."""
    settings = read(section, STABILITY_KEYS, file)
    kinds = Key(mapping, "a mapping of the solver's options, {} for none", None)
    solvers = read(settings["solvers"], dict.fromkeys(SOLVERS, kinds), file, "solvers")
    settings["solvers"] = {}
    for name in (name for name in SOLVERS if solvers[name] is not None):
        options = read(solvers[name], keys_of(solver_class(name)), file, f"solvers.{name}")
        try:
            solver(name, **options)
        except SceneError as error:
            raise error.within(file, f"solvers.{name}") from error
        settings["solvers"][name] = options
    if not settings["solvers"]:
        raise SceneError("solvers", {}, f"at least one of {', '.join(SOLVERS)}", file)
    return settings


def job_settings(settings: Mapping, hazard: str) -> dict:
    """What the cells of one hazard depend on."""
    modules = [module_of(name) for name in settings["solvers"]]
    return {
        "hazard": hazard,
        "severities": settings["severities"],
        "solvers": settings["solvers"],
        "source": digest(source_digest("contactsim.stability", *modules), versions()),
    }


def survey(hazard: str, severities: Sequence[float], solvers: Mapping[str, Mapping], source: str) -> xr.Dataset:
    """Every solver on one hazard at every severity: outcome, transforms and reason, by (solver, severity)."""
    cases = [HAZARDS[hazard](severity) for severity in severities]
    dimension = {1: Trait.LINE, 2: Trait.SURFACE}[cases[0].heights.ndim]
    methods = {name: solver(name, **solvers[name]) for name in sorted(solvers)}
    verdicts = []
    for name, method in methods.items():
        for severity, case in zip(severities, cases, strict=True):
            verdicts.append(judge(case, method))
            logger.info("%s %g, %s: %s %s", hazard, severity, name, verdicts[-1].outcome.value[1], verdicts[-1].reason)
    cells = np.array([(verdict.outcome.value[0], verdict.transforms) for verdict in verdicts]).T
    shape, dims = (len(methods), len(cases)), ("solver", "severity")
    data = xr.Dataset(
        {
            "outcome": (dims, cells[0].astype(np.int8).reshape(shape)),
            "transforms": (dims, cells[1].reshape(shape)),
            "reason": (dims, np.array([verdict.reason for verdict in verdicts], object).reshape(shape)),
            "tolerance": ("severity", [case.tolerance for case in cases]),
            "taken": ("solver", np.array([dimension in method.accepts for method in methods.values()], np.int8)),
            "harder": first_line(hazard),
        },
        coords={"hazard": hazard, "solver": list(methods), "severity": list(severities)},
    )
    settings = {"hazard": hazard, "severities": list(severities), "solvers": dict(solvers)}
    return dataset.stamped(_described(data), f"Stability: {hazard}", settings, source)


def gather(parts: Iterable[xr.Dataset], settings: Mapping, source: str) -> xr.Dataset:
    """The surveys of all hazards in one dataset, by (hazard, solver, severity)."""
    parts = [part.drop_encoding() for part in parts]  # or the first part's length would cut all text
    data = xr.concat(parts, "hazard", data_vars="all", coords="minimal", join="exact", combine_attrs="override")
    return dataset.stamped(_described(data), str(settings["title"]), settings, source)


def _described(data: xr.Dataset) -> xr.Dataset:
    data = dataset.described(data)
    values, meanings = [kind.value[0] for kind in Outcome], " ".join(kind.name.lower() for kind in Outcome)
    data["outcome"].attrs.update(flag_values=np.array(values, np.int8), flag_meanings=meanings)
    return data
