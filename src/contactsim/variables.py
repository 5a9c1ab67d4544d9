"""One table of variables: unit, long name, and how figures and sentences call them.

`RESULTS` has what a dataset may hold, `SETTINGS` the keys of a study that can be varied. What aggregation derives from a
variable has its name and a suffix.
"""

from __future__ import annotations

import re
from typing import NamedTuple


class Variable(NamedTuple):
    """An entry of the table.

    unit: "1" for ratios; long_name: what it is, in a few words; symbol: a symbol or two words for an axis, in mathtext;
    phrase: the same for a sentence, in letters that need no mathtext.
    """

    unit: str
    long_name: str
    symbol: str = ""
    phrase: str = ""


# The table has one line a variable.
# fmt: off
RESULTS = {
    "member": Variable("1", "member of the ensemble"),
    "reduced_pressure": Variable("1", "reduced pressure p* = p/(rms gradient × E*), over the whole surface", "$p^*$", "p*"),
    "mean_pressure": Variable("GPa", "mean pressure", "$p$", "p"),
    "contact_ratio": Variable("1", "exact contact half-width or radius over the radius of the cylinder or sphere", "$c/R$", "c/R"),
    "reduced_pressure_contact": Variable("1", "reduced pressure p_r* = p/(rms gradient in contact × E*)", "$p_r^*$", "pᵣ*"),
    "relative_contact_area": Variable("1", "relative contact area", r"$a_{\mathrm{rel}}$", "aᵣₑₗ"),
    "relative_contact_area_subgrid": Variable("1", "relative contact area, with its edges placed between points", r"$a_{\mathrm{rel}}$, edges between points", "aᵣₑₗ with edges between points"),
    "contact_edges": Variable("1", "pairs of neighbours of which one is in contact"),
    "rms_height": Variable("nm", "rms height of the profile"),
    "rms_gradient": Variable("1", "rms gradient of the profile (Eqs 3.8-3.9 over all points)"),
    "rms_curvature": Variable("1/nm", "rms curvature of the profile"),
    "rms_gradient_contact": Variable("1", "rms gradient over the contact (Eqs 3.8-3.9)", "gradient in contact", "ḡᵣ"),
    "rms_gradient_contact_pairs": Variable("1", "rms gradient over pairs of neighbours in contact", "gradient of pairs", "ḡᵣ of pairs"),
    "mean_gap": Variable("nm", "mean gap", "mean gap", "the mean gap"),
    "approach_first_touch": Variable("nm", "approach of first touch"),
    "kappa": Variable("1", "proportionality of area and pressure, gradient over all of the surface", r"$\kappa$", "κ"),
    "kappa_r": Variable("1", "proportionality of area and pressure, gradient over the contact (Eq. 3.8)", r"$\kappa_r$", "κᵣ"),
    "kappa_r_pairs": Variable("1", "proportionality of area and pressure, gradient over pairs in contact", r"$\kappa_r$ of pairs", "κᵣ of pairs"),
    "contact_radius_exact": Variable("nm", "radius of the contact, exact (Hertz)", phrase="the exact c"),
    "contact_radius": Variable("nm", "radius of the contact, of a circle of its area", phrase="c"),
    "half_width_exact": Variable("nm", "half-width of the contact, exact (Eq. 3.5)", phrase="the exact c"),
    "rms_gradient_exact": Variable("1", "rms gradient over the contact, exact (Eq. 3.6)", phrase="the exact ḡᵣ"),
    "half_width": Variable("nm", "half-width of the contact", phrase="c"),
    "iterations": Variable("1", "outer iterations of the solver"),
    "transforms": Variable("1", "real transforms, in equivalents of one on the finest grid"),
    "coarse_run_transforms": Variable("1", "real transforms of coarser runs before, in equivalents of one on the finest grid"),
    "accuracy": Variable("1", "relative error asked for"),
    "neglected": Variable("1", "effects that are neglected"),
    "decision": Variable("1", "which effects are neglected and which are not, and why"),
    "check_transforms": Variable("1", "real transforms of the check on a sample, in equivalents of one on the finest grid"),
    "neglect_change": Variable("1", "relative change without the neglected effects, on a sample"),
    "change_without": Variable("1", "largest relative change on leaving an effect out"),
    "accuracy_reached": Variable("1", "1 if the estimated error is within the accuracy asked for, 0 if not"),
    "coarse_run_points": Variable("1", "grid points along x of the coarser run before"),
    "refinements": Variable("1", "how often the grid was refined"),
    "max_contact_gap": Variable("1", "largest gap in contact, in grid steps (recomputed)"),
    "penetration": Variable("1", "largest overlap outside the contact, in grid steps (recomputed)"),
    "min_pressure": Variable("GPa", "smallest pressure"),
    "load_error": Variable("1", "relative error of the load"),
    "status": Variable("1", "status of the solution"),
    "seed": Variable("1", "root of the random numbers"),
    "seconds": Variable("s", "CPU time of the solution"),
    "point_digest": Variable("1", "digest of the code and settings that made the load step"),
    "contact_points": Variable("1", "number of points in contact"),
    "contact_bits": Variable("1", "contact set, eight points a byte, first point in the highest bit"),
    "contact_pressure": Variable("GPa", "pressure on the points in contact, load by load"),
    "points": Variable("1", "grid points along x"),
    "points_y": Variable("1", "grid points along y"),
    "length": Variable("nm", "period along x"),
    "length_y": Variable("nm", "period along y"),
    "contact_modulus": Variable("GPa", "contact modulus E*"),
    "heights": Variable("nm", "heights of the rigid surface, the largest touches first"),
    "pressure": Variable("GPa", "pressure"),
    "gap": Variable("nm", "gap"),
    "fit_b1": Variable("1", "parameter b1 of Eq. 3.11"),
    "fit_b2": Variable("1", "parameter b2 of Eq. 3.11"),
    "fitted": Variable("1", "profiles that a fit uses: one Hurst exponent, or all"),
    "weighting": Variable("1", "weighting of a fit: of the area itself or of its logarithm"),
    "fit_limit": Variable("1", "largest reduced pressure that a fit uses"),
    "hazard": Variable("1", "hazard"),
    "severity": Variable("1", "severity of the hazard, from 0 to 100"),
    "solver": Variable("1", "solver"),
    "outcome": Variable("1", "what came of a case"),
    "reason": Variable("1", "reason of a refusal or failure"),
    "tolerance": Variable("1", "tolerance, in grid steps, or in parts of the laws' strength"),
    "applicable": Variable("1", "1 if the solver accepts cases of the kind of the hazard, 0 if not"),
    "difficulty": Variable("1", "what gets harder with the severity"),
    "variant": Variable("1", "variant of the scene, by the effects that it lists"),
    "components": Variable("1", "components of displacement and traction that exist"),
    "scene": Variable("1", "scene drawn at random: its kind and number"),
    "description": Variable("1", "description of the scene"),
    "requested_error": Variable("1", "relative error requested of a scene"),
    "true_error": Variable("1", "relative error in truth, against a finer run"),
    "predicted_error": Variable("1", "predicted relative error"),
    "solve_count": Variable("1", "how often the scene was solved"),
    "predicted_points": Variable("1", "predicted grid points along x"),
    "work": Variable("1", "work: transforms times grid points"),
    "predicted_work": Variable("1", "predicted work"),
    "min_work": Variable("1", "work of the cheapest setting that is within the error asked for"),
    "min_work_points": Variable("1", "grid points along x of that setting, -1 for none"),
    "settings_tried": Variable("1", "settings tried"),
    "settings_within_error": Variable("1", "settings tried that are within the error asked for"),
    "unknowns": Variable("1", "real unknowns of a step"),
    "unconverged": Variable("1", "steps that did not converge"),
    "steps": Variable("1", "steps of the path"),
    "step": Variable("1", "step of the path"),
    "snapshot": Variable("nm", "approach, slide or mean pressure at which fields are kept"),
    "x": Variable("nm", "position along x"),
    "approach": Variable("nm", "approach of the bodies"),
    "line_load": Variable("N/m", "load, compression positive"),
    "repulsive_load": Variable("N/m", "push of the part under repulsion"),
    "adhesive_load": Variable("N/m", "pull of the part under adhesion"),
    "friction_force": Variable("N/m", "tangential force"),
    "contact_length": Variable("nm", "length of the contact under repulsion"),
    "interacting_length_0_1": Variable("nm", "length over which the traction exceeds a tenth of the strength"),
    "interacting_length_0_01": Variable("nm", "length over which the traction exceeds a hundredth of the strength"),
    "interacting_length_0_001": Variable("nm", "length over which the traction exceeds a thousandth of the strength"),
    "interacting_length_1e_6": Variable("nm", "length over which the traction exceeds a millionth of the strength"),
    "relative_repulsive_area": Variable("1", "part of the period under repulsion"),
    "relative_interacting_area": Variable("1", "part of the period where the traction exceeds a hundredth of the strength"),
    "rms_gradient_repulsive": Variable("1", "rms gradient over what is under repulsion (Eq. 3.8)"),
    "rms_gradient_interacting": Variable("1", "rms gradient where the traction exceeds a hundredth of the strength (Eq. 3.8)"),
    "gradient_ratio_repulsive": Variable("1", "rms gradient over what is under repulsion, over that of all"),
    "gradient_ratio_interacting": Variable("1", "rms gradient where surfaces interact, over that of all"),
    "normalised_pressure": Variable("1", "mean pressure over the contact modulus"),
    "normal_gap_bin": Variable("1", "normal gap, over the laws' length: middle of a bin; the ends hold what lies beyond"),
    "normal_traction_bin": Variable("1", "normal traction over the laws' strength: middle of a bin; the ends hold what lies beyond"),
    "normal_gap_share": Variable("1", "share of the points by normal gap"),
    "normal_traction_share": Variable("1", "share of the points by normal traction"),
    "min_gap": Variable("nm", "smallest gap"),
    "max_pressure": Variable("GPa", "largest pressure"),
    "max_tensile_traction": Variable("GPa", "largest pull"),
    "max_interpenetration": Variable("1", "deepest overlap, over the normal characteristic length"),
    "slip": Variable("1", "largest tangential gap under repulsion, over the tangential characteristic length"),
    "residual": Variable("1", "largest residual traction, over the strength of the laws (recomputed)"),
    "process_zone_step": Variable("1", "grid spacing over the length of the process zone"),
    "validity_flags": Variable("1", "limits of the model that the state exceeds, one bit each"),
    "solved_points": Variable("1", "grid points on which the state is a solution"),
    "jump": Variable("nm", "how far the surface jumped since the step before"),
    "lattice_constant": Variable("nm", "lattice constant of the sites that springs join"),
    "sliding_distance": Variable("nm", "distance that the upper body has slid along x"),
    "contact_trailing_edge": Variable("nm", "trailing edge of the contact, from the highest point of the upper surface"),
    "contact_leading_edge": Variable("nm", "leading edge of the contact, from the highest point of the upper surface"),
    "contact_slip": Variable("nm", "mean tangential gap where surfaces are closest"),
    "elastic_energy": Variable("nJ/m", "elastic energy, of bodies of unit thickness"),
    "static_friction": Variable("N/m", "largest tangential force before the first slip", "static friction", "Fₛ"),
    "mean_friction": Variable("N/m", "mean of the largest and the smallest tangential force from the onset of sliding on", "mean friction", "(Fₛ+Fₖ)/2"),
    "average_friction": Variable("N/m", "tangential force averaged over whole lattice constants of sliding", "average friction", "the mean force"),
    "onset_sliding_distance": Variable("nm", "slide at the largest tangential force before the first slip", "slide at the onset", "Uₓ at the onset"),
    "onset_contact_length": Variable("nm", "length of the contact at the onset of sliding", "contact length at the onset", "Aₛ"),
    "initial_contact_length": Variable("nm", "length of the contact before the slide", "contact length before the slide", "A₀"),
    "initial_load": Variable("N/m", "normal load before the slide", "load before the slide", "L before the slide"),
    "peeled_fraction": Variable("1", "part of the contact lost between the beginning of the slide and its onset", "peeled part", "peeled"),
    "reattached_fraction": Variable("1", "length of the contact after the first slip over that before the slide", "reattached part", "reattached"),
    "regained_fraction": Variable("1", "length of contact regained at the first slip, over that before the slide", "regained part", "regained"),
    "peel_asymmetry_halfway": Variable("1", "trailing less leading peel over their sum, half way to the onset of sliding", "asymmetry half way to the onset", "asymmetry half way to the onset"),
    "peel_asymmetry": Variable("1", "trailing less leading peel over their sum, at the onset of sliding", "asymmetry at the onset", "asymmetry"),
    "quadratic_coefficient": Variable("nm (m/N)^2", "coefficient of the quadratic law of contact length and force (Eq. 6.8)", r"$\zeta$", "ζ"),
    "quadratic_r_squared": Variable("1", "coefficient of determination of the quadratic law (Eq. 6.8)", "$R^2$ of Eq. 6.8", "R² of Eq. 6.8"),
    "slip_count": Variable("1", "number of slips along the path", "slips", "slips"),
    "first_force_drop": Variable("N/m", "drop of the tangential force at the first slip", "first drop", "the first drop"),
    "first_slip_periods": Variable("1", "how far the contact slips at first, in lattice constants", "cells of the first slip", "cells of the first slip"),
    "first_slip_released_energy": Variable("nJ/m", "elastic energy that the first slip releases", "energy of the first slip", "energy released at the first slip"),
    "loop_energy": Variable("nJ/m", "energy that a slide to and fro dissipates", "energy of a loop", "energy of a loop"),
    "event_sliding_distance": Variable("nm", "slide by which a slip had come"),
    "event": Variable("1", "slip, in the order in which they come"),
    "event_step": Variable("1", "step of the path during which a slip came"),
    "event_width": Variable("nm", "slide within which a slip came"),
    "event_force_before": Variable("N/m", "tangential force before a slip"),
    "event_force_after": Variable("N/m", "tangential force after a slip"),
    "event_slip": Variable("nm", "how far the contact slips"),
    "event_length_before": Variable("nm", "length of the contact before a slip"),
    "event_length_after": Variable("nm", "length of the contact after a slip"),
    "event_released_energy": Variable("nJ/m", "elastic energy that a slip releases"),
    "event_periods": Variable("1", "how far the contact slips, in lattice constants"),
    "shear_strength": Variable("GPa", "slope of force against contact length at the onset of sliding (Eq. 6.9)", phrase="τc"),
    "friction_without_contact": Variable("N/m", "tangential force at the onset without contact (Eq. 6.9)", phrase="Fₛ without contact"),
    "threshold_r_squared": Variable("1", "coefficient of determination of the threshold law (Eq. 6.9)", phrase="R² of Eq. 6.9"),
    "control": Variable("1", "what the path prescribes"),
    "strength": Variable("GPa", "strength of the laws"),
    "pull_off_load_loading": Variable("N/m", "largest pull on loading", "pull-off on loading", "the pull-off load"),
    "pull_off_load_unloading": Variable("N/m", "largest pull on unloading", "pull-off on unloading", "the pull-off load on unloading"),
    "pull_off_approach_loading": Variable("nm", "approach of the largest pull on loading", "approach of pull-off on loading", "the approach at pull-off"),
    "pull_off_approach_unloading": Variable("nm", "approach of the largest pull on unloading", "approach of pull-off on unloading", "the approach at pull-off on unloading"),
    "final_contact_length": Variable("nm", "length of the contact under repulsion at the largest approach", "contact length", "the contact size"),
    "final_interacting_length": Variable("nm", "length over which the traction exceeds a hundredth of the strength at the largest approach", "interacting length", "the interacting length"),
    "final_load": Variable("N/m", "load at the largest approach", "final load", "the load"),
    "final_repulsive_load": Variable("N/m", "push of the part under repulsion at the largest approach", "final push", "the repulsive force"),
    "final_adhesive_load": Variable("N/m", "pull of the part under adhesion at the largest approach", "final pull", "the adhesive force"),
    "final_max_pressure": Variable("GPa", "largest pressure at the largest approach", "final pressure", "the largest pressure"),
    "final_max_tensile_traction": Variable("GPa", "largest pull at the largest approach", "final traction", "the largest pull"),
    "final_slip": Variable("1", "largest tangential gap under repulsion at the largest approach, over the tangential characteristic length", "final slip", "the largest slip"),
    "max_jump_loading": Variable("nm", "largest jump of the surface on loading", "jump on loading", "the largest jump on loading"),
    "max_jump_unloading": Variable("nm", "largest jump of the surface on unloading", "jump on unloading", "the largest jump on unloading"),
    "dissipated_energy": Variable("nJ/m", "energy that a cycle dissipates, of bodies of unit thickness", "dissipated energy", "energy of a cycle"),
    "dissipated_work": Variable("N/m", "energy that a cycle dissipates, over the nominal area", "dissipated work", "energy of a cycle by area"),
    "nonlinearity": Variable("1", "sine of the angle between area and pressure over a curve", "non-linearity", "the non-linearity"),
    "nonlinearity_reduced": Variable("1", "sine of the angle between area and reduced pressure over a curve", "non-linearity of $p_r^*$", "the non-linearity in pᵣ*"),
    "curvature": Variable("1", "part of the square in a parabola of pressure against area", "curvature", "the curvature"),
    "curvature_reduced": Variable("1", "part of the square in a parabola of reduced pressure against area", "curvature of $p_r^*$", "the curvature in pᵣ*"),
    "pressure_at_area_0_02": Variable("1", "pressure over E* where the relative area first reaches 0.02", "$p/E^*$ at $a=0.02$", "p/E* at aᵣₑₗ = 0.02"),
    "pressure_at_area_0_1": Variable("1", "pressure over E* where the relative area first reaches 0.1", "$p/E^*$ at $a=0.1$", "p/E* at aᵣₑₗ = 0.1"),
    "pressure_at_area_one_third": Variable("1", "pressure over E* where the relative area first reaches 1/3", "$p/E^*$ at $a=1/3$", "p/E* at aᵣₑₗ = 1/3"),
    "area_at_12nm": Variable("1", "relative area at an approach of 12 nm beyond first touch", "$a$ at 12 nm", "aᵣₑₗ at 12 nm"),
    "pressure_at_12nm": Variable("1", "pressure over E* at an approach of 12 nm beyond first touch", "$p/E^*$ at 12 nm", "p/E* at 12 nm"),
    "gradient_ratio_at_area_0_02": Variable("1", "rms gradient over the contact, over that of all, at a relative area of 0.02", r"$\bar g_r/\bar g$ at $a=0.02$", "ḡᵣ/ḡ at aᵣₑₗ = 0.02"),
    "normal_gap": Variable("nm", "normal gap"),
    "tangential_gap": Variable("nm", "tangential gap"),
    "opening": Variable("nm", "normal gap along a curve"),
    "slip_gap": Variable("nm", "tangential gap along a curve"),
    "normal_displacement": Variable("nm", "normal displacement of the lower relative to the upper surface"),
    "tangential_displacement": Variable("nm", "tangential displacement of the lower relative to the upper surface"),
    "normal_traction": Variable("GPa", "normal traction, pull positive"),
    "tangential_traction": Variable("GPa", "tangential traction"),
    "profile_real": Variable("nm", "real part of the profile's Fourier coefficients"),
    "profile_imag": Variable("nm", "imaginary part of the profile's Fourier coefficients"),
}
"""Variables and dimensions that a dataset may hold, also those that aggregation derives."""
SETTINGS = {
    "hurst_exponent": Variable("1", "Hurst exponent", "$H$", "H"),
    "length": Variable("nm", "period", phrase="w"),
    "long_cutoff": Variable("nm", "long cut-off (roll-off) wavelength"),
    "short_cutoff": Variable("nm", "short cut-off wavelength of the roughness"),
    "rms_gradient": Variable("1", "rms gradient prescribed"),
    "rms_height": Variable("nm", "rms height prescribed", phrase="hᵣₘₛ"),
    "low_pass_cutoff": Variable("nm", "wavelength of the low-pass filter: shorter waves are left out"),
    "amplitudes": Variable("1", "distribution of the amplitudes"),
    "width": Variable("nm", "period along y"),
    "dimensions": Variable("1", "dimensions of the surface"),
    "radius": Variable("nm", "radius of the cylinder or sphere"),
    "amplitude": Variable("nm", "amplitude of the wave"),
    "periods": Variable("1", "number of waves in a period"),
    "increment": Variable("nm", "increment asked for"),
    "height": Variable("nm", "height of the plane"),
    "file": Variable("1", "file of a measured profile or surface"),
    "detrend": Variable("1", "how a measured profile or surface is detrended"),
    "periodic": Variable("1", "how a measured profile or surface is made periodic"),
    "spacing": Variable("nm", "spacing of a measured profile or surface"),
    "unit": Variable("1", "unit of a measured profile's or surface's file"),
    "variable": Variable("1", "variable of a measured profile's or surface's file"),
    "contact_modulus": Variable("GPa", "contact modulus E*"),
    "poisson_ratio": Variable("1", "Poisson's ratio", "Poisson's ratio ν", "ν"),
    "thickness": Variable("nm", "thickness", phrase="h"),
    "kind": Variable("1", "kind"),
    "youngs_modulus": Variable("GPa", "Young's modulus", phrase="E"),
    "work_of_separation": Variable("N/m", "normal work of separation", phrase="φn"),
    "work_ratio": Variable("1", "tangential over normal work of separation", "φt/φn", "φt/φn"),
    "normal_length": Variable("nm", "normal characteristic length"),
    "tangential_length": Variable("nm", "tangential characteristic length"),
    "lattice_constant": Variable("nm", "lattice constant of the sites that springs join", phrase="l"),
    "tangential_cutoff": Variable("1", "tangential cutoff of the lattice, over the tangential characteristic length", phrase="tangential cutoff"),
    "normal_cutoff": Variable("1", "largest gap that springs bridge, over the normal characteristic length", phrase="normal cutoff"),
    "weight": Variable("1", "weight of a spring"),
    "approach": Variable("nm", "approach at which surfaces slide", phrase="δ"),
    "mean_pressure": Variable("GPa", "mean pressure under which surfaces slide", phrase="p"),
}
"""Keys of a study that can be varied; options of a solver are not here and have unit 1."""
# fmt: on
SECTIONS = re.compile("^(surface|body|counter_body|solver|increments|pairing|slide)_")
"""Section of a key at the beginning of the name of its dimension."""
LOADS = ("mean_pressure", "reduced_pressure", "contact_ratio")
"""By which loads on their own are prescribed; a study has one of them, and its dataset the dimension of that name."""
ERRORS = {
    "grid": "change of the mean on halving the grid",
    "increment": "what the increments of the path leave open",
    "tolerance": "change of the mean on solving more tightly",
    "neglect": "change on neglecting nothing",
    "estimated": "error as estimated from a coarser run before",
}
"""Kinds of error beside the standard one, and what each is: of a quantity NAME that of a kind is NAME_KIND_error."""
SUFFIXES = {
    "_difference_standard_error": ": standard error of the difference, member by member",
    "_difference": ": mean difference from a reference, member by member",
    "_limit_standard_error": ": standard error over members of the limit on finer grids",
    "_limit": ": mean over members, extrapolated to the limit on finer grids",
    "_order_standard_error": ": standard error over members of the order of convergence",
    "_order": ": order of convergence of the mean with the grid, as observed",
    "_spread": ": the limit on finer grids less that of first order",
    "_change_standard_error": ": standard error of the change, member by member",
    "_change": ": change from a reference, as a part of it",
    "_mean": ": mean over members",
    "_standard_error": ": standard error of the mean over members",
    **{f"_{kind}_error": f": {text}" for kind, text in ERRORS.items()},
    "_half_width": ": half-width of the 95 % confidence interval",
}
"""What aggregation adds to a variable's name, and to its long name."""


def base_name(name: str) -> tuple[str, str]:
    """Return a variable's name without the suffix of aggregation, and the suffix in words."""
    if name in RESULTS:
        return name, ""
    for suffix, text in SUFFIXES.items():
        if name.endswith(suffix):
            return name.removesuffix(suffix), text
    return name, ""


def find_variable(name: str) -> Variable:
    """Return the entry of a variable or of a varied key by its name in a dataset; an unknown name is an option."""
    setting = SECTIONS.sub("", name)
    return RESULTS.get(name) or SETTINGS.get(setting) or Variable("1", f"option {name}")


def dimension_name(key: str) -> str:
    """Return the name of the dimension along which a dotted key of a study is varied.

    It is the last part of the key, with its section before it where something else has that name.
    """
    section, _, last = key.rpartition(".")
    ambiguous = last in RESULTS or last == "kind" or section in ("counter_body", "increments")
    return f"{section}_{last}" if section and ambiguous else last
