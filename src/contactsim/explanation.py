"""What a scene will cost and why: its effects, the fields that exist, what was left out, who may solve it.

Everything said here is read off the scene and the solvers' own declarations, so it is what the simulation does.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from contactsim.contact.scene import Scene
from contactsim.dataset import SETTINGS
from contactsim.interface.pairing import Pairing
from contactsim.interface.registry import EFFECTS
from contactsim.paths.increments import Increments
from contactsim.paths.options import Setup
from contactsim.solvers.registry import SOLVERS, default_solver, is_installed, solver_class
from contactsim.traits import Trait

COMPONENTS = {"n": "normal", "t": "tangential"}


@dataclass(frozen=True)
class Explanation:
    """A scene in words and numbers.

    effects: those that are on, with what they read and exert; pairing: which points face which; fields: what exists at
    each point; left_out: what does not, and why; unknowns: of one load step; increments: how smooth laws are walked;
    transforms: of an iteration; megabytes: peak, about; solvers: for each that exists, why not, or nothing; chosen: the
    solver that will be used.
    """

    bodies: tuple[str, str]
    effects: dict[str, str]
    fields: tuple[str, ...]
    left_out: dict[str, str]
    pairing: str
    unknowns: int
    steps: int
    increments: str
    transforms: float
    megabytes: float
    solvers: dict[str, str]
    chosen: str

    @property
    def text(self) -> str:
        """The explanation as it is printed."""
        refused = [
            f"{name}: {why}" if why else f"{name}{' (chosen)' * (name == self.chosen)}"
            for name, why in self.solvers.items()
        ]
        parts = {
            "above": [self.bodies[0]],
            "below": [self.bodies[1]],
            "effects on": [f"{name}: {what}" for name, what in self.effects.items()],
            "pairing": [self.pairing],
            "fields that exist": list(self.fields),
            "left out, and why": [f"{name}: {why}" for name, why in self.left_out.items()],
            "unknowns": [f"{self.unknowns} at each of {self.steps} load steps"],
            **({"increments": [self.increments]} if self.increments else {}),
            "cost": [f"{self.transforms:g} real transforms an iteration, about {self.megabytes:.3g} MB"],
            "solvers": refused,
        }
        return "\n".join(f"{head}\n" + "\n".join(f"  {line}" for line in lines) for head, lines in parts.items())


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
        bodies=(_body(scene, "upper"), _body(scene, "lower")),
        effects={_name(effect): _effect(effect) for effect in scene.effects},
        fields=tuple(
            f"{COMPONENTS[component]} {field}"
            for component in scene.components
            for field in ("displacement", *["traction"] * (component in scene.exerted))
        ),
        left_out=dict.fromkeys(neglected, "as the study asks") | _left_out(scene),
        pairing=_described(scene.pairing) + _slide(scene),
        unknowns=size * exerted,
        steps=len(scene.path.steps),
        increments="" if options.increments is None else _described(options.increments),
        transforms=method.transforms(setup.points) * exerted,
        megabytes=method.fields * len(scene.components) * size * 8 / 1e6,
        solvers={name: _why_not(scene, name) for name in SOLVERS},
        chosen=next(name for name in SOLVERS if is_installed(name) and type(method) is solver_class(name)),
    )


def _body(scene: Scene, side: str) -> str:
    body = getattr(scene, side)
    kind = type(body.surface).__name__
    if body.elasticity is None:
        return f"{kind}, rigid"
    others = [entry.name for entry in fields(body.elasticity) if entry.name != "contact_modulus"]
    given = {name: getattr(body.elasticity, name) for name in others}
    named = "".join(f", {_setting(name, value)}" for name, value in given.items() if value is not None)
    return f"{kind}, {type(body.elasticity).__name__} with E* = {body.elasticity.contact_modulus:g} GPa{named}"


def _setting(key: str, value: float) -> str:
    unit, name = SETTINGS[key]
    return f"{name} {value:g}" + f" {unit}" * (unit != "1")


def _name(effect: object) -> str:
    return next(name for name, kind in EFFECTS.items() if isinstance(effect, kind))


def _effect(effect: object) -> str:
    reads, exerts = (" and ".join(COMPONENTS[c] for c in sorted(parts)) for parts in (effect.reads, effect.exerts))
    first = type(effect).__doc__.split("\n")[0].rstrip(".")
    return f"{first}; reads the {reads} gap, exerts {exerts} traction"


def _described(kind: Increments | Pairing) -> str:
    """What the class says of itself, and its options that are given."""
    given = {entry.name: getattr(kind, entry.name) for entry in fields(kind)}
    options = ", ".join(f"{name} {value}" for name, value in given.items() if value is not None)
    return type(kind).__doc__.split("\n")[0].rstrip(".") + f" ({options})" * bool(options)


def _slide(scene: Scene) -> str:
    """How far the upper body slides, and under what."""
    slides = [step for step in scene.path.steps if step.held is not None]
    if not slides:
        return ""
    distances = [step.sliding_distance for step in slides]
    ends = f"from {min(distances):g} to {max(distances):g} nm"
    return f"; the upper body slides along x {ends} in {len(slides)} steps, at {slides[-1].held.text}"


def _left_out(scene: Scene) -> dict[str, str]:
    """What does not exist in a scene, and why."""
    unused = "no effect reads or exerts them" if scene.slips else "the surfaces do not slip: laws have no slip to feel"
    out = {
        f"{COMPONENTS[component]} displacement and traction": unused
        for component in COMPONENTS
        if component not in scene.components
    }
    out |= {
        f"{COMPONENTS[component]} unknowns": "no effect exerts it: it follows the normal displacement, wave by wave"
        for component in scene.components
        if component not in scene.exerted
    }
    for side in ("upper", "lower"):
        if getattr(scene, side).elasticity is None:
            out[f"deformation of the {side} body"] = "rigid: absent, not stiff"
    if len(scene.elasticities) == 2:
        out["the second displacement field"] = "aligned bodies: their compliances add"
    if scene.compliance(np.zeros(1))[0] == 0:
        free, kept = "free on a half-space: zero by convention", "zero: an incompressible layer keeps its volume"
        out["mean displacement"] = free if Trait.HALF_SPACE in scene.traits else kept
    unlisted = [name for name, kind in EFFECTS.items() if not any(isinstance(on, kind) for on in scene.effects)]
    return out | dict.fromkeys(unlisted, "does not act")


def _why_not(scene: Scene, name: str) -> str:
    if not is_installed(name):
        return "is not installed"
    missing = sorted(trait.value for trait in scene.traits - solver_class(name).accepts)
    return f"does not take {missing[0]}" if missing else ""
