"""Cases that get harder: from severity 0 to 100, and what is right at each.

A hazard is a function of its severity that returns a case: heights, a load and, where it is known, the right answer.
"""

from __future__ import annotations

from collections.abc import Callable

from contactsim.hazards import lines, surfaces
from contactsim.hazards.cases import Case

HAZARDS: dict[str, Callable[[float], Case]] = {
    hazard.__name__: hazard
    for hazard in (
        lines.few_points,
        lines.light_wave,
        lines.first_touch,
        lines.nearly_full_wave,
        lines.nearly_full_rough,
        lines.last_gap,
        lines.full_contact,
        lines.equal_heights,
        lines.tall_spike,
        lines.deep_pit,
        lines.deep_groove,
        lines.low_spike,
        lines.flat,
        lines.white_noise,
        lines.grazing,
        lines.steep_slopes,
        lines.awkward_sizes,
        lines.units,
        lines.far_datum,
        lines.thin_layer,
        lines.incompressible_layer,
        lines.thin_incompressible_layer,
        lines.thick_layer,
        lines.pushed_layer,
        lines.zero_load,
        lines.tension,
        lines.tight_tolerance,
        surfaces.light_surface,
        surfaces.surface_first_touch,
        surfaces.nearly_full_surface,
        surfaces.surface_last_gap,
        surfaces.full_surface,
        surfaces.flat_punch,
        surfaces.tall_post,
        surfaces.low_post,
        surfaces.deep_hole,
        surfaces.chequerboard,
        surfaces.grazing_surface,
        surfaces.wide_range,
        surfaces.far_surface,
        surfaces.ridges,
        surfaces.oblong_cells,
        surfaces.oblong_grid,
        surfaces.awkward_grids,
        surfaces.incompressible_surface_layer,
        surfaces.thin_incompressible_surface_layer,
        surfaces.pushed_surface_layer,
        surfaces.tight_surface_tolerance,
    )
}


def first_line(hazard: str) -> str:
    """What gets harder, in a sentence: the first line of the hazard's docstring."""
    return HAZARDS[hazard].__doc__.splitlines()[0]
