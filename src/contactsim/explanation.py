"""Explain a scene: its effects, the fields that exist, the parts that do not, its cost, and the solvers that apply.

All is read off the scene and the solvers' own declarations, so it is what the simulation does.
"""

from __future__ import annotations

import re
import textwrap
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass

import numpy as np

from contactsim.contact.scene import Body, Scene
from contactsim.interface.base import Effect
from contactsim.interface.registry import EFFECTS
from contactsim.paths.options import Setup
from contactsim.solvers.base import HardWallSolver
from contactsim.solvers.cohesive.base import CohesiveSolver
from contactsim.solvers.registry import SOLVERS, default_solver, is_installed, solver_class
from contactsim.traits import Trait
from contactsim.variables import SETTINGS

COMPONENTS = {"n": "normal", "t": "tangential"}


@dataclass(frozen=True)
class Explanation:
    """A scene in words and numbers.

    Parameters
    ----------
    bodies : (str, str)
        The upper and the lower body.
    effects : dict
        Effects that act, with what they read and exert.
    fields : tuple of str
        Quantities that exist at each point.
    missing : dict
        Parts that do not exist, and why.
    pairing : str
        Which points face each other.
    unknowns, steps : int
        Unknowns of one load step, and number of steps.
    increments : str
        Increments of a path of cohesive laws.
    transforms : float
        Real transforms of an iteration.
    megabytes : float
        Approximate memory at its peak.
    solvers : dict
        Reason for which each solver does not apply; empty where it does.
    solver : str
        The solver that will be used.
    """

    bodies: tuple[str, str]
    effects: dict[str, str]
    fields: tuple[str, ...]
    missing: dict[str, str]
    pairing: str
    unknowns: int
    steps: int
    increments: str
    transforms: float
    megabytes: float
    solvers: dict[str, str]
    solver: str

    def __str__(self) -> str:
        """Return the explanation in lines of words."""
        return self.text

    @property
    def text(self) -> str:
        """The explanation as it is printed."""
        others = [name for name, reason in self.solvers.items() if not reason and name != self.solver]
        parts = {
            "upper body": [self.bodies[0]],
            "lower body": [self.bodies[1]],
            "effects": [line for name, text in self.effects.items() for line in f"{name}: {text}".split("\n")],
            "pairing": [self.pairing],
            "fields": list(self.fields),
            "left out": _reason_lines(self.missing),
            "unknowns": [f"{self.unknowns} at each of {self.steps} load steps"],
            "increments": [self.increments],
            "cost": [f"{self.transforms:g} real transforms in each iteration; arrays of about {self.megabytes:.3g} MB"],
            "solver": [self.solver],
            "other solvers that can solve it": others,
            "solvers that cannot": _reason_lines({name: reason for name, reason in self.solvers.items() if reason}),
        }
        parts = {head: lines for head, lines in parts.items() if any(lines)}
        return "\n".join(line for head, lines in parts.items() for line in (head, *map(_indent, lines)))


def _indent(line: str) -> str:
    """Return a line below a head, broken where it is long."""
    return textwrap.fill(f"  {line}", 120, subsequent_indent="    ", break_on_hyphens=False)


def _reason_lines(reasons: Mapping[str, str]) -> list[str]:
    """Return a line for each reason, with the names that it holds for before it."""
    return [
        f"{', '.join(name for name, other in reasons.items() if other == reason)}: {reason}"
        for reason in dict.fromkeys(reasons.values())
    ]


def explain_setup(setup: Setup, neglected: Sequence[str] = ()) -> Explanation:
    """Explain which effects of a scene act, which fields exist, and what an iteration costs.

    Parameters
    ----------
    setup : Setup
        Scene and options: grid, solver and increments.
    neglected : sequence of str, optional
        Effects that were neglected on request.
    """
    scene, options = setup.scene, setup.options
    method = options.solver or default_solver(scene)
    size, exerted = setup.size, len(scene.exerted)
    return Explanation(
        bodies=(_describe_body(scene.upper), _describe_body(scene.lower)),
        effects={_effect_name(effect): _describe_effect(effect) for effect in scene.effects},
        fields=tuple(
            f"{COMPONENTS[component]} {field}"
            for component in scene.components
            for field in ("displacement", *["traction"] * (component in scene.exerted))
        ),
        missing=dict.fromkeys(neglected, "as the study asks") | _missing_parts(scene),
        pairing=_describe_options(scene.pairing) + _describe_slide(scene),
        unknowns=size * exerted,
        steps=len(scene.path.steps),
        increments="" if options.increments is None else _describe_options(options.increments),
        transforms=method.transforms(setup.points) * exerted,
        megabytes=method.fields * len(scene.components) * size * 8 / 1e6,
        solvers={name: _refusal(scene, name) for name in SOLVERS},
        solver=_solver_name(method),
    )


def _solver_name(solver: HardWallSolver | CohesiveSolver) -> str:
    """Return the name of a solver in the config, or that of its class if it has none."""
    names = [name for name in SOLVERS if is_installed(name) and type(solver) is solver_class(name)]
    return names[0] if names else type(solver).__name__


def _describe_body(body: Body) -> str:
    """Return the surface and the elasticity of a body in words."""
    kind = type(body.surface).__name__
    if body.elasticity is None:
        return f"{kind}, rigid"
    values = _field_values(body.elasticity)
    settings = [_describe_setting(name, values[name]) for name in values if name != "contact_modulus"]
    solid = f"{type(body.elasticity).__name__} with E* = {body.elasticity.contact_modulus:g} GPa"
    return ", ".join([kind, solid, *settings])


def _describe_setting(key: str, value: object) -> str:
    """Return a setting with its unit."""
    variable = SETTINGS[key]
    return f"{variable.long_name} {value:g}" + f" {variable.unit}" * (variable.unit != "1")


def _effect_name(effect: Effect) -> str:
    """Return the name of an effect in the config, or that of its class if it has none."""
    names = [name for name, kind in EFFECTS.items() if isinstance(effect, kind)]
    return names[0] if names else type(effect).__name__


def _describe_effect(effect: Effect) -> str:
    """Return what an effect is, and on a second line what it reads and exerts."""
    reads, exerts = (" and ".join(COMPONENTS[c] for c in sorted(parts)) for parts in (effect.reads, effect.exerts))
    return f"{_first_sentence(effect)}\n  It reads the {reads} gap and exerts {exerts} traction"


def _describe_options(item: object) -> str:
    """Return the first sentence of an object's class, and its options."""
    options = ", ".join(f"{name} = {value}" for name, value in _field_values(item).items())
    return _first_sentence(item) + f"; {options}" * bool(options)


def _first_sentence(item: object) -> str:
    """Return the first sentence of the docstring of an object's class, without its full stop."""
    paragraph = " ".join((type(item).__doc__ or "").split("\n\n")[0].split())
    return re.split(r"\.(?= [A-Z])|\.$", paragraph)[0]


def _field_values(item: object) -> dict[str, object]:
    """Return the fields of a dataclass that have a value."""
    names = [entry.name for entry in fields(item)] if is_dataclass(item) else []
    return {name: getattr(item, name) for name in names if getattr(item, name) is not None}


def _describe_slide(scene: Scene) -> str:
    """Return the slide of the upper body in words; empty without one."""
    slides = [step for step in scene.path.steps if step.slides]
    if not slides:
        return ""
    distances = [step.sliding_distance for step in slides]
    ends = f"from {min(distances):g} to {max(distances):g} nm"
    return f"; the upper body slides along x {ends} in {len(slides)} steps, at {slides[-1].normal.text}"


def _missing_parts(scene: Scene) -> dict[str, str]:
    """Return the parts that do not exist in a scene, and why."""
    unused = "no effect reads or exerts them" if scene.slips else "the surfaces do not slip"
    parts = {
        f"{COMPONENTS[component]} displacement and traction": unused
        for component in COMPONENTS
        if component not in scene.components
    }
    follows = "no effect exerts this traction; the displacement follows the normal one, wave by wave"
    parts |= {
        f"{COMPONENTS[component]} unknowns": follows for component in scene.components if component not in scene.exerted
    }
    for side, body in (("upper", scene.upper), ("lower", scene.lower)):
        if body.elasticity is None:
            parts[f"deformation of the {side} body"] = "it is rigid"
    if len(scene.elasticities) == 2:
        parts["the second displacement field"] = "aligned bodies: their compliances add"
    if scene.compliance(np.zeros(1))[0] == 0 and scene.repeats:
        free, fixed = "zero by convention, as on a half-space it is free", "an incompressible layer keeps its volume"
        parts["mean displacement"] = free if Trait.HALF_SPACE in scene.traits else fixed
    unlisted = [name for name, kind in EFFECTS.items() if not any(isinstance(effect, kind) for effect in scene.effects)]
    return parts | dict.fromkeys(unlisted, "not among the effects of the scene")


def _refusal(scene: Scene, name: str) -> str:
    """Return the reason for which a solver cannot solve a scene; empty if it can."""
    if not is_installed(name):
        return "not installed"
    missing = [trait for trait in Trait if trait in scene.traits - solver_class(name).accepts]
    if not missing:
        return ""
    words, _, meaning = missing[0].value.partition(": ")
    return f"not made for {words}" + f" ({meaning})" * bool(meaning)
