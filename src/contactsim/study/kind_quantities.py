"""Names of the quantities of studies of each kind of problem; what is simulated does not depend on them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from contactsim.contact.problem_kind import ProblemKind
from contactsim.contact.scene import Scene
from contactsim.observables.deformation import DEFORMATIONS
from contactsim.observables.friction import ONSET
from contactsim.observables.hysteresis import CYCLE, CYCLES
from contactsim.observables.linearity import AREA_LOAD
from contactsim.observables.path_summary import FINAL, SUMMARIES, SUMMARY
from contactsim.observables.threshold import ALONG, THRESHOLD


class KindQuantities(Protocol):
    """Quantities of one kind of problem.

    Attributes
    ----------
    comparable
        Those whose change can say whether an effect is negligible.
    """

    comparable: tuple[str, ...]

    def path_quantities(self, scene: Scene, dimensions: Sequence[str]) -> set[str]:
        """Return the names of the summaries of a path; dimensions: of the study's dataset."""
        ...


class HardWallQuantities:
    """Quantities of loads at a hard wall."""

    comparable: tuple[str, ...] = ("relative_contact_area", "relative_contact_area_subgrid", "mean_gap")

    def path_quantities(self, scene: Scene, dimensions: Sequence[str]) -> set[str]:
        """Return how area and load of a path through given approaches are related."""
        return set(AREA_LOAD)


class CohesiveQuantities:
    """Quantities of paths of cohesive laws."""

    comparable: tuple[str, ...] = (*SUMMARY, *CYCLE, *AREA_LOAD, *ONSET)

    def path_quantities(self, scene: Scene, dimensions: Sequence[str]) -> set[str]:
        """Return what load curves, cycles and slides amount to, as far as the scene has them."""
        dimensions_of_scene, slips = len(scene.lengths), "t" in scene.components
        own = (*SUMMARIES[dimensions_of_scene], *CYCLES[dimensions_of_scene], *DEFORMATIONS[dimensions_of_scene])
        names = {name for name in own if slips or FINAL.get(name) != "slip"}
        if scene.sliding:
            names |= {*ONSET, *(f"{name}_increment_error" for name in ONSET)}
            names |= {*(THRESHOLD if set(ALONG) & set(dimensions) else ())}
        return names | set(AREA_LOAD)


KIND_QUANTITIES: dict[ProblemKind, KindQuantities] = {
    ProblemKind.HARD_WALL: HardWallQuantities(),
    ProblemKind.COHESIVE: CohesiveQuantities(),
}
