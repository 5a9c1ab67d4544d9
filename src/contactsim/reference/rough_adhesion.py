"""When rough surfaces stick: the criterion of Pastewka and Robbins (PNAS 111, 3298, 2014, doi:10.1073/pnas.1320846111).

Short-ranged attraction acts in a rim about each patch of repulsive contact. Surfaces stick if the rims pull more than
the patches push. Patches are d = 4ḡ/c wide, with the rms gradient ḡ and the rms curvature c. They push with the mean
pressure ḡE*/κ. The gap beside them is 4ḡ/3 √(x³/d) at a distance x, so it is the attraction's range r where
x/d = (3r/(4ḡd))^(2/3). The rim of that width pulls with w/r, and has π x/d of the area of the patch.
"""

from __future__ import annotations

import math

KAPPA = 2.0
"""Contact area over reduced pressure without adhesion, as Pastewka and Robbins take it."""


def attraction_over_repulsion(
    work: float,
    attraction_range: float,
    contact_modulus: float,
    rms_gradient: float,
    rms_curvature: float,
    kappa: float = KAPPA,
) -> float:
    """Return the pull of the rims over the push of the patches; surfaces stick above one.

    Parameters
    ----------
    work
        Work of adhesion w, N/m.
    attraction_range
        Range r of the attraction, nm: the work over the largest attraction, e δn of the exponential law.
    contact_modulus
        E*, GPa.
    rms_gradient
        Rms gradient ḡ of a surface.
    rms_curvature
        Rms of the mean of both curvatures c, 1/nm.
    kappa
        Contact area over reduced pressure without adhesion.
    """
    diameter = 4 * rms_gradient / rms_curvature
    rim = (3 * attraction_range / (4 * rms_gradient * diameter)) ** (2 / 3)
    pull, push = work / attraction_range, rms_gradient * contact_modulus / kappa
    return math.pi * rim * pull / push


def sticking_work(
    attraction_range: float, contact_modulus: float, rms_gradient: float, rms_curvature: float, kappa: float = KAPPA
) -> float:
    """Return the work of adhesion (N/m) from which surfaces stick; parameters as of `attraction_over_repulsion`."""
    return 1 / attraction_over_repulsion(1.0, attraction_range, contact_modulus, rms_gradient, rms_curvature, kappa)
