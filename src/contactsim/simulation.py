"""Simulate a scene, forecast its cost, neglect effects, and explain what it does."""

from __future__ import annotations

import logging
from collections.abc import Sequence

import xarray as xr

from contactsim.arguments import Count, Positive, checked
from contactsim.contact.scene import Scene
from contactsim.error_control.effect_maps import neglect_effects
from contactsim.error_control.forecast import Forecast, forecast_run
from contactsim.error_control.ladder import solve_to_error, solve_with_errors
from contactsim.error_control.neglect import Decision, decide_neglect
from contactsim.error_control.options import check_quantities
from contactsim.errors import InputError, is_positive
from contactsim.explanation import Explanation, explain_setup
from contactsim.grid import Threads
from contactsim.paths.driver import follow_path
from contactsim.paths.increments import Increments
from contactsim.paths.options import Accuracy, RunOptions, Setup
from contactsim.solvers.base import HardWallSolver
from contactsim.solvers.cohesive.base import CohesiveSolver
from contactsim.solvers.registry import SolverName, make_solver
from contactsim.status import warn_of_excess

logger = logging.getLogger(__name__)


@checked
def simulate(
    scene: Scene,
    *,
    points: Count | None = None,
    tolerance: float | None = None,
    accuracy: float | None = None,
    errors: bool = False,
    quantities: Sequence[str] = (),
    solver: SolverName | HardWallSolver | CohesiveSolver | None = None,
    increments: Increments | None = None,
    snapshots: Sequence[float] | None = None,
    keep: Sequence[str] | None = None,
    keep_fields: bool | None = None,
    until: str | None = None,
    threads: Threads = 1,
) -> xr.Dataset:
    """Follow the load path of a scene.

    Grid, tolerance and increments are as given or, with an accuracy, chosen for it: the scene is solved on finer and
    finer grids, in shorter and shorter increments, until the error that their changes tell is small enough.

    Parameters
    ----------
    scene : Scene
        Bodies, effects and load path.
    points : int, optional
        Grid points along x; a measured surface comes with its own.
    tolerance : float, optional
        In grid steps at a hard wall, in parts of the strength with cohesive laws; 1e-3 by default.
    accuracy : float, optional
        Relative error of the quantities, in place of points, tolerance and increments. A path of single values keeps
        them: what lies between them is no part of the error.
    errors : bool
        True to tell the errors of quantities on the points given: the scene is solved on coarser grids too.
    quantities : sequence of str, optional
        Quantities whose error counts or is told; those usual for the scene by default.
    solver : str or solver, optional
        Name of a solver, or a solver with options of its own; the default solver of the scene where None.
    increments : Increments, optional
        How a path of cohesive laws is followed: `Requested()` (the default), `Adaptive(...)` or `Nested(...)`.
    snapshots : sequence of float, optional
        With cohesive laws: values of the path near which histograms and fields are kept.
    keep : sequence of str, optional
        At a hard wall: what to keep of each solution, some of "contact", "pressure", "profile", "fields",
        "distributions" of pressure and gap, "patches" of contact, and "stiffness" of the contact; the first three by
        default.
    keep_fields : bool, optional
        With cohesive laws: False to keep histograms alone at the snapshots.
    until : str, optional
        With cohesive laws: "complete_contact" ends the path where every gap is closed.
    threads : int
        Threads of the transforms; results are the same bit for bit at one number of threads.

    Returns
    -------
    xarray.Dataset
        One dataset with dimension `step`: numbers, and what is kept. `seconds` is the one variable that is not
        reproducible. With an accuracy, or errors, `NAME_estimated_error` is the error of a quantity, in its unit.

    Raises
    ------
    InputError
        For an option that the scene has no use for, a solver that does not accept it, or an accuracy that no
        affordable grid reaches.
    """
    options = RunOptions(
        points=points,
        tolerance=1e-3 if tolerance is None else tolerance,
        solver=_find_solver(solver),
        threads=threads,
        keep=None if keep is None else tuple(keep),
        increments=increments,
        snapshots=None if snapshots is None else tuple(snapshots),
        keep_fields=keep_fields,
        until=until,
    )
    setup = Setup(scene, options)
    if accuracy is None:
        if quantities and not errors:
            raise InputError("quantities", list(quantities), "none without an accuracy or errors")
        data = solve_with_errors(setup, tuple(quantities)).data if errors else follow_path(setup)
        warn_of_excess(data)
        return data
    wanted = _read_accuracy(
        accuracy, quantities, points=points, tolerance=tolerance, increments=increments, errors=errors or None
    )
    controlled = solve_to_error(setup, wanted.error, wanted.quantities)
    if not controlled.met:
        logger.warning("an accuracy of %g is not reached: %s", controlled.wanted, controlled.summary)
    warn_of_excess(controlled.data)
    return controlled.data


@checked
def estimate_cost(
    scene: Scene,
    *,
    points: Count | None = None,
    tolerance: Positive | None = None,
    accuracy: float | None = None,
    quantities: Sequence[str] = (),
    increments: Increments | None = None,
) -> Forecast:
    """Forecast work, time and memory of a simulation before it runs; parameters as in `simulate`.

    Raises
    ------
    InputError
        For a scene whose costs were not measured.
    """
    wanted = None
    if accuracy is not None:
        wanted = _read_accuracy(accuracy, quantities, points=points, tolerance=tolerance, increments=increments)
    elif quantities:
        raise InputError("quantities", list(quantities), "none without an accuracy")
    options = RunOptions(points, 1e-3 if tolerance is None else tolerance, accuracy=wanted, increments=increments)
    return forecast_run(Setup(scene, options))


def _read_accuracy(accuracy: float, quantities: Sequence[str], **others: object) -> Accuracy:
    """Return the accuracy that is asked for; InputError where options are given that follow from it."""
    for name, value in others.items():
        if value is not None:
            raise InputError(name, value, "left out, for it follows from the accuracy")
    return Accuracy(accuracy, tuple(quantities))


@checked
def neglect(
    scene: Scene,
    *,
    within: float,
    quantities: Sequence[str],
    points: Count,
    tolerance: Positive = 1e-3,
    increments: Increments | None = None,
) -> tuple[Scene, Decision]:
    """Return a scene without the effects that hardly change it, and why.

    The effects are proposed by maps that were measured, and checked by solving the scene with and without them on a
    coarser grid.

    Parameters
    ----------
    scene : Scene
        Scene with all its effects.
    within : float
        Relative change that the quantities may have, above 0 and below 1.
    quantities : sequence of str
        Quantities to compare; those usual for the scene where empty.
    points, tolerance, increments
        Grid, tolerance and increments that the scene will be simulated with; see `simulate`.

    Raises
    ------
    InputError
        For a change outside its range, and for quantities that are none.
    """
    if not (is_positive(within) and within < 1):
        raise InputError("within", within, "a relative change, above 0 and below 1")
    setup = Setup(scene, RunOptions(points=points, tolerance=tolerance, increments=increments))
    decision = decide_neglect([setup], within, check_quantities(setup, quantities))
    return neglect_effects(setup, decision.neglected).scene, decision


@checked
def explain(
    scene: Scene,
    *,
    points: Count | None = None,
    solver: SolverName | HardWallSolver | CohesiveSolver | None = None,
    increments: Increments | None = None,
) -> Explanation:
    """Explain which effects of a scene act, which fields exist, what an iteration costs, and which solvers apply.

    Parameters
    ----------
    scene : Scene
        Bodies, effects and load path.
    points, solver, increments
        As in `simulate`.

    Returns
    -------
    Explanation
        Print it, or read its attributes.
    """
    return explain_setup(Setup(scene, RunOptions(points=points, solver=_find_solver(solver), increments=increments)))


def _find_solver(solver: str | HardWallSolver | CohesiveSolver | None) -> HardWallSolver | CohesiveSolver | None:
    """Return a solver by its name, or the solver itself."""
    return make_solver(solver) if isinstance(solver, str) else solver
