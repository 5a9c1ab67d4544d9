"""Neglect effects that hardly change a scene: proposed by maps, checked on a sample.

The maps (`contactsim.error_control.effect_maps`) say which effects may be neglected to a tolerance. A sample of members
is then solved with and without them on a coarser grid, which costs little and hardly changes how much they matter. What
the check does not bear out stays. An effect that the maps find near the tolerance is checked as well; one that no map
knows stays.
"""

from __future__ import annotations

import json
import logging
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, field, replace

from contactsim.code_digest import computing_digest
from contactsim.contact.problem_kind import ProblemKind
from contactsim.contact.scene import Scene
from contactsim.contact.simplification import SIMPLIFICATIONS
from contactsim.error_control.effect_maps import FILE, change_without, expected_change
from contactsim.error_control.options import coarser_setups
from contactsim.error_control.solution import Solution
from contactsim.errors import InputError
from contactsim.paths.options import Setup
from contactsim.paths.requested import Requested
from contactsim.provenance import digest

logger = logging.getLogger(__name__)

NEAR_FACTOR = 10.0
"""Multiple of the tolerance up to which an effect is checked."""
LOOSE_TOLERANCE = 1e-5
"""Tolerance of a check along a path, in parts of the strength, if that of the run is not looser."""


@dataclass
class Decision:
    """Effects that are neglected, and why.

    Parameters
    ----------
    neglected : list of str
        Effects that are neglected.
    expected : dict
        Relative change by effect as the maps expect it; None where no map knows it.
    measured : dict
        Relative change by effect on the sample, as far as it was checked.
    together : float
        Relative change on the sample without all of them.
    description : str
        What was done, in words.
    work : float
        Transforms times points of the check.
    seconds : float
        CPU seconds of the check, which are not reproducible and kept apart.
    """

    neglected: list[str] = field(default_factory=list)
    expected: dict[str, float | None] = field(default_factory=dict)
    measured: dict[str, float] = field(default_factory=dict)
    together: float = 0.0
    description: str = ""
    work: float = 0.0
    seconds: float = 0.0

    @property
    def text(self) -> str:
        """The decision as JSON, without its seconds."""
        return json.dumps({name: value for name, value in asdict(self).items() if name != "seconds"}, indent=1)


def decision_digest() -> str:
    """Return a digest of what decides: the code and the maps."""
    return digest(computing_digest("contactsim.error_control.neglect"), FILE.read_text(encoding="utf-8"))


def neglectable_effects(scene: Scene) -> list[str]:
    """Return the effects of a scene that can be neglected."""
    return [name for name, simplify in SIMPLIFICATIONS.items() if _simplifies(scene, simplify)]


def _simplifies(scene: Scene, simplify: Callable[[Scene], Scene]) -> bool:
    """Return True where a scene has an effect, and is a scene without it."""
    try:
        return simplify(scene) != scene
    except InputError:
        return False


def expected_neglect(scene: Scene, tolerance: float) -> list[str]:
    """Return the effects that the maps find negligible."""
    changes = {name: expected_change(scene, name) for name in neglectable_effects(scene)}
    return [name for name, change in changes.items() if change is not None and change <= tolerance]


def decide_neglect(samples: Sequence[Setup], tolerance: float, quantities: Sequence[str]) -> Decision:
    """Decide which effects to neglect: those that change quantities by a tolerance at most, each and all together.

    samples: the scene with all its effects, for each member of the sample
    """
    scene = samples[0].scene
    decision = Decision(expected={name: expected_change(scene, name) for name in neglectable_effects(scene)})
    checks: list[tuple[Setup, dict[str, Solution]]] = [(_coarse_check(setup), {}) for setup in samples]

    def measure(effects: list[str]) -> float:
        """Return the largest change on the sample."""
        return max(change_without(setup, effects, quantities, solutions) for setup, solutions in checks)

    changes = {name: value for name, value in decision.expected.items() if value is not None}
    near = {name: value for name, value in changes.items() if value <= NEAR_FACTOR * tolerance}
    decision.neglected = [name for name, value in near.items() if value <= tolerance]
    decision.together = measure(decision.neglected) if decision.neglected else 0.0
    if decision.together > tolerance or len(decision.neglected) < len(near):  # each on its own
        decision.measured = {name: measure([name]) for name in near}
        decision.neglected = [name for name, value in decision.measured.items() if value <= tolerance]
        decision.together = measure(decision.neglected) if decision.neglected else 0.0
    while decision.together > tolerance:
        decision.neglected.remove(max(decision.neglected, key=decision.measured.__getitem__))
        decision.together = measure(decision.neglected) if decision.neglected else 0.0
    solutions = [solution for _, solved in checks for solution in solved.values()]
    decision.work = sum(solution.transforms * solution.size for solution in solutions)
    decision.seconds = sum(solution.seconds for solution in solutions)
    decision.description = _describe(decision, tolerance)
    logger.info(decision.description)
    return decision


def _coarse_check(setup: Setup) -> Setup:
    """Return a setup on a quarter of its grid, or on the coarsest that shows the scene; as it is on a coarser one."""
    setup = setup.with_options(accuracy=None)
    if setup.scene.kind is ProblemKind.COHESIVE:
        setup = setup.with_options(tolerance=max(setup.options.tolerance, LOOSE_TOLERANCE), increments=Requested())
    try:
        coarse = coarser_setups(setup)[0]
    except InputError:
        return setup
    return replace(coarse, scene=replace(coarse.scene, path=setup.scene.path))


def _describe(decision: Decision, tolerance: float) -> str:
    """Return what was done, effect by effect."""
    parts, unknown = [], [name for name, value in decision.expected.items() if value is None]
    for name, value in decision.expected.items():
        if value is not None:
            measured = decision.measured.get(name)
            checked = "" if measured is None else f", {measured:.2g} on the sample".replace("inf", "not to be compared")
            action = "left out" if name in decision.neglected else "kept"
            parts.append(f"{name} {action}, {value:.2g} by the maps{checked}")
    parts += [f"together {decision.together:.2g} on the sample"] * bool(decision.neglected)
    parts += [f"kept, as no map knows: {', '.join(unknown)}"] * bool(unknown)
    return f"within {tolerance:g}: " + "; ".join(parts or ["there is nothing to leave out"])
