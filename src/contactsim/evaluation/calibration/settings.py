"""The settings of config/trials.yaml, and what each job of them depends on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from contactsim.error_control.scaling import FILE
from contactsim.evaluation.calibration.population import KIND_NAMES
from contactsim.evaluation.calibration.trial import Trial
from contactsim.evaluation.figure_settings import FIGURE_KEYS, FigureSettings
from contactsim.provenance import digest
from contactsim.solvers.registry import DEFAULT_SOLVERS, solver_module
from contactsim.study.reading import Key, choice, listed, mapping, positive, read, whole
from contactsim.study.stages import computing_stage_digest, stage_digest
from contactsim.study.tier_overrides import tiered

MAX_SCENES = 1000
"""Most scenes of a kind."""
DRAW_KEYS = {
    "seed": Key(whole(0), "a whole number, 0 or more"),
    "scenes": Key(whole(1, MAX_SCENES), "how many of each kind"),
}
KEYS = FIGURE_KEYS | {
    "calibration": Key(mapping, "a mapping with `seed` and `scenes`"),
    "trial": Key(mapping, "a mapping with `seed` and `scenes`"),
    "errors": Key(listed(positive), "a list of relative errors that are asked for"),
    "kinds": Key(listed(choice(KIND_NAMES)), f"a list of some of {', '.join(KIND_NAMES)}", list(KIND_NAMES)),
}


@dataclass(frozen=True)
class Draws:
    """The seed of scenes, and how many there are of each kind."""

    seed: int
    scenes: int


@dataclass(frozen=True)
class Trials(FigureSettings):
    """Scenes to which factors and relations are fitted, scenes on trial, errors to request, and kinds of scenes."""

    calibration: Draws
    trial: Draws
    errors: Sequence[float]
    kinds: Sequence[str]

    def names(self, draws: Draws) -> list[str]:
        """Return the names of all scenes that are drawn, which are those of their files."""
        return [f"{kind}_{count}" for kind in self.kinds for count in range(draws.scenes)]


def read_trials(folder: str | Path, over: dict, tier: str) -> Trials | None:
    """Return the settings of trials.yaml with a tier's changes; None without that file."""
    source = tiered(Path(folder) / "trials.yaml", over, tier)
    if source is None:
        return None
    section, file = source
    settings: dict[str, Any] = read(section, KEYS, file)
    for part in ("calibration", "trial"):
        settings[part] = Draws(**read(settings[part], DRAW_KEYS, file, part))
    return Trials(**settings)


def trial_job(trials: Trials, draws: Draws, stage: str, kind: str, count: int) -> dict[str, Any]:
    """Return what one scene on trial, or measured for a fit, depends on; stage: `trial` or `measure_scaling`.

    What is fitted does not depend on the relations that it starts from: else fitting would never settle.
    """
    modules = [computing_stage_digest(stage, *(solver_module(name) for name in DEFAULT_SOLVERS.values()))]
    modules += [FILE.read_text(encoding="utf-8")] * (stage == "trial")
    return {"settings": asdict(Trial.draw(draws.seed, trials.errors, kind, count)), "source": digest(modules)}


def trials_figure_job(trials: Trials, tier: str) -> dict[str, Any]:
    """Return what the figure of all trials depends on."""
    draws = trials.trial
    data = [trial_job(trials, draws, "trial", kind, count) for kind in trials.kinds for count in range(draws.scenes)]
    code = stage_digest("trials_figure")
    return {"settings": trials.layout, "tier": tier, "seed": draws.seed, "source": code, "data": digest(data)}
