"""Result datasets: dimensions, units, attributes, provenance; the only reader and writer of netCDF.

Everything written is reproducible bit for bit at one number of threads, so times and memory are kept elsewhere. A file
appears under its name only when it is complete.
"""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import xarray as xr

from contactsim.errors import SceneError
from contactsim.files import write_atomically
from contactsim.provenance import canonical, versions
from contactsim.solvers.base import Status
from contactsim.validity import FLAGS

SETTINGS = {
    "hurst": ("1", "Hurst exponent"),
    "length": ("nm", "period"),
    "rolloff_wavelength": ("nm", "roll-off wavelength"),
    "shortest_wavelength": ("nm", "shortest wavelength of the roughness"),
    "rms_gradient": ("1", "rms gradient prescribed"),
    "rms_height": ("nm", "rms height prescribed"),
    "smoothed": ("nm", "wavelength below which waves are left out"),
    "amplitudes": ("1", "distribution of the amplitudes"),
    "width": ("nm", "period along y"),
    "dimensions": ("1", "dimensions of the surface"),
    "radius": ("nm", "radius of the cylinder or sphere"),
    "amplitude": ("nm", "amplitude of the wave"),
    "periods": ("1", "number of waves in a period"),
    "height": ("nm", "height of the plane"),
    "file": ("1", "file of a measured profile or surface"),
    "detrend": ("1", "how a measured profile or surface is detrended"),
    "periodic": ("1", "how a measured profile or surface is made periodic"),
    "spacing": ("nm", "spacing of a measured profile or surface"),
    "unit": ("1", "unit of a measured profile's or surface's file"),
    "variable": ("1", "variable of a measured profile's or surface's file"),
    "contact_modulus": ("GPa", "contact modulus E*"),
    "poisson_ratio": ("1", "Poisson's ratio"),
    "thickness": ("nm", "thickness"),
    "kind": ("1", "kind"),
    "youngs_modulus": ("GPa", "Young's modulus"),
    "work_of_separation": ("N/m", "normal work of separation"),
    "work_ratio": ("1", "tangential over normal work of separation"),
    "normal_length": ("nm", "normal characteristic length"),
    "tangential_length": ("nm", "tangential characteristic length"),
    "lattice_constant": ("nm", "lattice constant of the sites that springs join"),
    "window": ("1", "window of the springs, over the tangential characteristic length"),
    "depth": ("1", "largest gap that springs bridge, over the normal characteristic length"),
    "weight": ("1", "weight of a spring"),
    "approach": ("nm", "approach at which surfaces slide"),
    "mean_pressure": ("GPa", "mean pressure under which surfaces slide"),
}
"""Unit and long name of the keys of a study that can be varied; a solver's options have unit 1."""

VARIABLES = {
    "member": ("1", "member of the ensemble"),
    "reduced_pressure": ("1", "reduced pressure p* = p/(rms gradient × E*), over the whole surface"),
    "mean_pressure": ("GPa", "mean pressure"),
    "contact_ratio": ("1", "exact contact half-width or radius over the radius of the cylinder or sphere"),
    "reduced_pressure_contact": ("1", "reduced pressure p_r* = p/(rms gradient in contact × E*)"),
    "relative_contact_area": ("1", "relative contact area"),
    "relative_contact_area_subgrid": ("1", "relative contact area, with its edges placed between points"),
    "contact_edges": ("1", "pairs of neighbours of which one is in contact"),
    "rms_height": ("nm", "rms height of the profile"),
    "rms_gradient": ("1", "rms gradient of the profile (Eqs 3.8-3.9 over all points)"),
    "rms_curvature": ("1/nm", "rms curvature of the profile"),
    "rms_gradient_contact": ("1", "rms gradient over the contact (Eqs 3.8-3.9)"),
    "rms_gradient_contact_bond": ("1", "rms gradient over pairs of neighbours in contact"),
    "mean_gap": ("nm", "mean gap"),
    "approach_found": ("nm", "approach at which the load is carried"),
    "approach_first_touch": ("nm", "approach of first touch"),
    "kappa": ("1", "proportionality of area and pressure, gradient over all of the surface"),
    "kappa_r": ("1", "proportionality of area and pressure, gradient over the contact (Eq. 3.8)"),
    "kappa_r_bond": ("1", "proportionality of area and pressure, gradient over pairs in contact"),
    "contact_radius_exact": ("nm", "radius of the contact, exact (Hertz)"),
    "contact_radius": ("nm", "radius of the contact, of a circle of its area"),
    "half_width_exact": ("nm", "half-width of the contact, exact (Eq. 3.5)"),
    "rms_gradient_exact": ("1", "rms gradient over the contact, exact (Eq. 3.6)"),
    "half_width": ("nm", "half-width of the contact"),
    "iterations": ("1", "outer iterations of the solver"),
    "transforms": ("1", "real transforms, in equivalents of one on the finest grid"),
    "transforms_before": ("1", "real transforms of coarser runs before, in equivalents of one on the finest grid"),
    "accuracy": ("1", "relative error asked for"),
    "left_out": ("1", "effects left out as negligible"),
    "decision": ("1", "what was left out as negligible and what was not, and why"),
    "transforms_of_check": ("1", "real transforms of the check on a sample, in equivalents of one on the finest grid"),
    "left_out_change": ("1", "relative change without them, on a sample"),
    "change_without": ("1", "largest relative change on leaving an effect out"),
    "reached": ("1", "whether the accuracy is reached, as estimated"),
    "points_before": ("1", "grid points along x of the coarser run before"),
    "refinements": ("1", "how often the grid was refined"),
    "non_uniformity": ("1", "largest gap in contact, in grid steps (recomputed)"),
    "penetration": ("1", "largest overlap outside the contact, in grid steps (recomputed)"),
    "smallest_pressure": ("GPa", "smallest pressure"),
    "load_error": ("1", "relative error of the load"),
    "status": ("1", "status of the solution"),
    "seed": ("1", "root of the random numbers"),
    "seconds": ("s", "CPU time of the solution"),
    "point": ("1", "digest of the code and settings that made the point"),
    "contact_points": ("1", "number of points in contact"),
    "contact_bits": ("1", "contact set, eight points a byte, first point in the highest bit"),
    "contact_pressure": ("GPa", "pressure on the points in contact, load by load"),
    "points": ("1", "grid points along x"),
    "points_y": ("1", "grid points along y"),
    "length": ("nm", "period along x"),
    "length_y": ("nm", "period along y"),
    "contact_modulus": ("GPa", "contact modulus E*"),
    "heights": ("nm", "heights of the rigid surface, the largest touches first"),
    "pressure": ("GPa", "pressure"),
    "gap": ("nm", "gap"),
    "fit_b1": ("1", "parameter b1 of Eq. 3.11"),
    "fit_b2": ("1", "parameter b2 of Eq. 3.11"),
    "fitted": ("1", "profiles that a fit uses: one Hurst exponent, or all"),
    "weighting": ("1", "weighting of a fit: of the area itself or of its logarithm"),
    "fit_limit": ("1", "largest reduced pressure that a fit uses"),
    "hazard": ("1", "hazard"),
    "severity": ("1", "severity of the hazard, from 0 to 100"),
    "solver": ("1", "solver"),
    "outcome": ("1", "what came of a case"),
    "reason": ("1", "reason of a refusal or failure"),
    "tolerance": ("1", "tolerance, in grid steps, or in parts of the laws' strength"),
    "taken": ("1", "whether the solver takes cases of the hazard's kind"),
    "harder": ("1", "what gets harder with the severity"),
    "rung": ("1", "rung of the ladder of effects"),
    "components": ("1", "components of displacement and traction that exist"),
    "scene": ("1", "scene drawn at random: its kind and number"),
    "words": ("1", "scene in words"),
    "asked": ("1", "relative error asked of a scene"),
    "true_error": ("1", "relative error in truth, against a finer run"),
    "expected_error": ("1", "relative error as it was expected"),
    "solved": ("1", "how often the scene was solved"),
    "points_expected": ("1", "grid points along x, as expected"),
    "work": ("1", "work: transforms times grid points"),
    "work_expected": ("1", "work as expected"),
    "least_work": ("1", "work of the cheapest setting that is within the error asked for"),
    "least_points": ("1", "grid points along x of that setting, -1 for none"),
    "settings_tried": ("1", "settings tried"),
    "settings_met": ("1", "settings tried that are within the error asked for"),
    "unknowns": ("1", "real unknowns of a step"),
    "unconverged": ("1", "steps that did not converge"),
    "steps": ("1", "steps of the path"),
    "step": ("1", "step of the path"),
    "snapshot": ("nm", "approach, slide or mean pressure at which fields are kept"),
    "x": ("nm", "position along x"),
    "approach": ("nm", "approach"),
    "line_load": ("N/m", "load, compression positive"),
    "repulsive_load": ("N/m", "push of the part under repulsion"),
    "adhesive_load": ("N/m", "pull of the part under adhesion"),
    "friction_force": ("N/m", "tangential force"),
    "repulsive_length": ("nm", "length of the contact under repulsion"),
    "interacting_length_tenth": ("nm", "length over which the traction exceeds a tenth of the strength"),
    "interacting_length_hundredth": ("nm", "length over which the traction exceeds a hundredth of the strength"),
    "interacting_length_thousandth": ("nm", "length over which the traction exceeds a thousandth of the strength"),
    "interacting_length_millionth": ("nm", "length over which the traction exceeds a millionth of the strength"),
    "relative_repulsive_area": ("1", "part of the period under repulsion"),
    "relative_interacting_area": ("1", "part of the period where the traction exceeds a hundredth of the strength"),
    "rms_gradient_repulsive": ("1", "rms gradient over what is under repulsion (Eq. 3.8)"),
    "rms_gradient_interacting": ("1", "rms gradient where the traction exceeds a hundredth of the strength (Eq. 3.8)"),
    "gradient_ratio_repulsive": ("1", "rms gradient over what is under repulsion, over that of all"),
    "gradient_ratio_interacting": ("1", "rms gradient where surfaces interact, over that of all"),
    "normalised_pressure": ("1", "mean pressure over the contact modulus"),
    "normal_gap_bin": ("1", "normal gap, over the laws' length: middle of a bin; the ends hold what lies beyond"),
    "normal_traction_bin": (
        "1",
        "normal traction over the laws' strength: middle of a bin; the ends hold what lies beyond",
    ),
    "normal_gap_share": ("1", "share of the points by normal gap"),
    "normal_traction_share": ("1", "share of the points by normal traction"),
    "smallest_gap": ("nm", "smallest gap"),
    "largest_pressure": ("GPa", "largest pressure"),
    "largest_pull": ("GPa", "largest pull"),
    "overclosure": ("1", "deepest overlap, over the normal characteristic length"),
    "slip": ("1", "largest tangential gap under repulsion, over the tangential characteristic length"),
    "residual": ("1", "largest residual traction, over the strength of the laws (recomputed)"),
    "process_zone_step": ("1", "grid spacing over the length of the process zone"),
    "beyond": ("1", "which limits of what the model describes the state is beyond"),
    "solved_points": ("1", "grid points on which the state is a solution"),
    "jump": ("nm", "how far the surface jumped since the step before"),
    "lattice_constant": ("nm", "lattice constant of the sites that springs join"),
    "slid": ("nm", "how far the upper body has moved along x"),
    "contact_trailing": ("nm", "trailing edge of the contact, from the highest point of the upper surface"),
    "contact_leading": ("nm", "leading edge of the contact, from the highest point of the upper surface"),
    "contact_slip": ("nm", "mean tangential gap where surfaces are closest"),
    "elastic_energy": ("nJ/m", "elastic energy, of bodies of unit thickness"),
    "static_friction": ("N/m", "largest tangential force before the first slip"),
    "mean_friction": ("N/m", "mean of the largest and the smallest tangential force from the onset of sliding on"),
    "average_friction": ("N/m", "tangential force averaged over whole lattice constants of sliding"),
    "onset_slide": ("nm", "slide at the largest tangential force before the first slip"),
    "onset_repulsive_length": ("nm", "length of the contact at the onset of sliding"),
    "initial_repulsive_length": ("nm", "length of the contact before the slide"),
    "initial_load": ("N/m", "normal load before the slide"),
    "peeled": ("1", "part of the contact lost between the beginning of the slide and its onset"),
    "reattached": ("1", "length of the contact after the first slip over that before the slide"),
    "regained": ("1", "length of contact regained at the first slip, over that before the slide"),
    "asymmetry_early": ("1", "trailing less leading peel over their sum, half way to the onset of sliding"),
    "asymmetry": ("1", "trailing less leading peel over their sum, at the onset of sliding"),
    "quadratic_coefficient": ("nm (m/N)^2", "coefficient of the quadratic law of contact length and force (Eq. 6.8)"),
    "quadratic_agreement": ("1", "coefficient of determination of the quadratic law (Eq. 6.8)"),
    "slips": ("1", "number of slips"),
    "first_drop": ("N/m", "drop of the tangential force at the first slip"),
    "first_periods": ("1", "how far the contact slips at first, in lattice constants"),
    "first_released_energy": ("nJ/m", "elastic energy that the first slip releases"),
    "loop_energy": ("nJ/m", "energy that a slide to and fro dissipates"),
    "event_slide": ("nm", "slide by which a slip had come"),
    "event": ("1", "slip, in the order in which they come"),
    "event_step": ("1", "step of the path during which a slip came"),
    "event_width": ("nm", "slide within which a slip came"),
    "event_force_before": ("N/m", "tangential force before a slip"),
    "event_force_after": ("N/m", "tangential force after a slip"),
    "event_slip": ("nm", "how far the contact slips"),
    "event_length_before": ("nm", "length of the contact before a slip"),
    "event_length_after": ("nm", "length of the contact after a slip"),
    "event_released_energy": ("nJ/m", "elastic energy that a slip releases"),
    "event_periods": ("1", "how far the contact slips, in lattice constants"),
    "shear_strength": ("GPa", "slope of force against contact length at the onset of sliding (Eq. 6.9)"),
    "friction_without_contact": ("N/m", "tangential force at the onset without contact (Eq. 6.9)"),
    "threshold_agreement": ("1", "coefficient of determination of the threshold law (Eq. 6.9)"),
    "control": ("1", "what the path prescribes"),
    "strength": ("GPa", "strength of the laws"),
    "pull_off_load_loading": ("N/m", "largest pull on loading"),
    "pull_off_load_unloading": ("N/m", "largest pull on unloading"),
    "pull_off_approach_loading": ("nm", "approach of the largest pull on loading"),
    "pull_off_approach_unloading": ("nm", "approach of the largest pull on unloading"),
    "final_repulsive_length": ("nm", "length of the contact under repulsion at the largest approach"),
    "final_interacting_length": (
        "nm",
        "length over which the traction exceeds a hundredth of the strength at the largest approach",
    ),
    "final_load": ("N/m", "load at the largest approach"),
    "final_repulsive_load": ("N/m", "push of the part under repulsion at the largest approach"),
    "final_adhesive_load": ("N/m", "pull of the part under adhesion at the largest approach"),
    "final_pressure": ("GPa", "largest pressure at the largest approach"),
    "final_pull": ("GPa", "largest pull at the largest approach"),
    "final_slip": (
        "1",
        "largest tangential gap under repulsion at the largest approach, over the tangential characteristic length",
    ),
    "largest_jump_loading": ("nm", "largest jump of the surface on loading"),
    "largest_jump_unloading": ("nm", "largest jump of the surface on unloading"),
    "dissipated_energy": ("nJ/m", "energy that a cycle dissipates, of bodies of unit thickness"),
    "dissipated_work": ("N/m", "energy that a cycle dissipates, over the nominal area"),
    "nonlinearity": ("1", "sine of the angle between area and pressure over a curve"),
    "nonlinearity_reduced": ("1", "sine of the angle between area and reduced pressure over a curve"),
    "curvature": ("1", "part of the square in a parabola of pressure against area"),
    "curvature_reduced": ("1", "part of the square in a parabola of reduced pressure against area"),
    "pressure_at_fiftieth": ("1", "pressure over E* where the relative area first reaches 0.02"),
    "pressure_at_tenth": ("1", "pressure over E* where the relative area first reaches 0.1"),
    "pressure_at_third": ("1", "pressure over E* where the relative area first reaches 1/3"),
    "area_at_twelve": ("1", "relative area at an approach of 12 nm beyond first touch"),
    "pressure_at_twelve": ("1", "pressure over E* at an approach of 12 nm beyond first touch"),
    "gradient_at_fiftieth": ("1", "rms gradient over the contact, over that of all, at a relative area of 0.02"),
    "normal_gap": ("nm", "normal gap"),
    "tangential_gap": ("nm", "tangential gap"),
    "opening": ("nm", "normal gap along a curve"),
    "slip_gap": ("nm", "tangential gap along a curve"),
    "normal_displacement": ("nm", "normal displacement of the lower relative to the upper surface"),
    "tangential_displacement": ("nm", "tangential displacement of the lower relative to the upper surface"),
    "normal_traction": ("GPa", "normal traction, pull positive"),
    "tangential_traction": ("GPa", "tangential traction"),
    "profile_real": ("nm", "real part of the profile's Fourier coefficients"),
    "profile_imag": ("nm", "imaginary part of the profile's Fourier coefficients"),
}
"""Unit and long name of every variable that a dataset may hold."""


def described(data: xr.Dataset) -> xr.Dataset:
    """The dataset with units and long_name on every variable; a derived one inherits those of its base name."""
    for name in data.variables:
        base, kind = base_name(str(name))
        unit, text = (
            VARIABLES.get(base)
            or SETTINGS.get(re.sub("^(surface|body|counter_body|solver|pairing|slide)_", "", base))
            or ("1", f"option {base}")
        )
        data[name].attrs.update(units=unit, long_name=f"{text}{kind}")
    if "status" in data:
        values = [status.value[0] for status in Status]
        meanings = " ".join(status.name.lower() for status in Status)
        data["status"].attrs.update(flag_values=np.array(values, np.int8), flag_meanings=meanings)
    if "beyond" in data:
        masks = np.array(list(FLAGS.values()), np.int8)
        data["beyond"].attrs.update(flag_masks=masks, flag_meanings=" ".join(FLAGS))
    return data


def dimension(key: str) -> str:
    """Name of the dimension along which a key of a study is varied: its last part, unless something else has it."""
    section, _, last = key.rpartition(".")
    own = last in VARIABLES or last == "kind" or section == "counter_body"
    return f"{section}_{last}" if section and own else last


ERRORS = {
    "grid": "change of the mean on halving the grid",
    "increment": "what the increments of the path leave open",
    "tolerance": "change of the mean on solving more tightly",
    "left_out": "change on leaving nothing out",
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
    """A variable's name without what aggregation has added, and how that is put in words."""
    if name in VARIABLES:
        return name, ""
    for suffix, text in SUFFIXES.items():
        if name.endswith(suffix):
            return name.removesuffix(suffix), text
    return name, ""


def stamped(data: xr.Dataset, title: str, settings: object, source: str) -> xr.Dataset:
    """The dataset with its provenance: title, settings as JSON, digest of the source, versions."""
    data.attrs = {
        "title": title,
        "settings": canonical(settings),
        "source_digest": source,
        "versions": canonical(versions()),
        "Conventions": "CF-1.11",
    }
    return data


def write(data: xr.Dataset, path: str | Path) -> None:
    """Write a dataset, large arrays compressed, in one move: a reader sees the old file or the new one."""
    encoding = {}
    for name, item in data.variables.items():
        if item.dtype.kind in "fiu":
            encoding[name] = {"_FillValue": None, "fletcher32": item.ndim > 0}  # checksums: damage is an error
            if item.nbytes > 1 << 14:
                encoding[name] |= {"zlib": True, "complevel": 1}
    kind = {"engine": "netcdf4", "format": "NETCDF4", "encoding": encoding}
    write_atomically(path, lambda file: data.to_netcdf(file, **kind))


def read(path: str | Path) -> xr.Dataset:
    """Read a dataset into memory and close the file."""
    try:
        return xr.load_dataset(path, engine="netcdf4")
    except (OSError, RuntimeError, ValueError) as error:
        raise SceneError("dataset", Path(path), f"a readable netCDF file ({error})") from error


def settings_of(data: xr.Dataset) -> dict:
    """The settings stored with a dataset."""
    return json.loads(data.attrs["settings"])
