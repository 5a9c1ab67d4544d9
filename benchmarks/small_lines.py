"""What line contacts of few points cost: the default solver beside Polonsky–Keer, in ratios of CPU time.

    pip install -e .[benchmark] SurfaceTopography ContactMechanics
    python benchmarks/small_lines.py    # about five minutes

Solvers take turns in one process on one thread, from the heights to the certified solution. ContactMechanics gets the
largest tolerance, of two in each decade, at which our certificate accepts its pressure; its certificate is not timed. A
number is the ratio to the default solver, median over the rounds and mean over the members; nan where a solver fails.
The shortest wave has eight points.
"""

from __future__ import annotations

import itertools
import logging
import time
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from statistics import median

import measure
import numpy as np
from peers import RUNGS, pressed_by_contact_mechanics
from records import on_one_thread
from report import insert, markdown

from contactsim import HalfSpace, HardWall, Scene, SelfAffine, pressures
from contactsim.contact.pose_hard_wall import pose_hard_wall
from contactsim.grid import Array
from contactsim.solvers.registry import is_installed

README = Path(__file__).resolve().parent / "README.md"
SIZES = (64, 128, 256, 512, 1024, 2048, 4096)
PRESSURES = (1e-3, 1e-2, 1e-1)
TOLERANCE, MEMBERS, ROUNDS, GRADIENT = 1e-6, 3, 9, 0.1
BEGIN, END = "<!-- small lines: written by small_lines.py -->", "<!-- end of small lines -->"
DEFAULT, OTHERS, PEER = "active_set", ("polonsky_keer", "tamaas"), "ContactMechanics"

logger = logging.getLogger("small_lines")


def timed(scene: Scene, heights: Array, solver: str) -> dict:
    """Return one solution with a solver, and its CPU seconds."""
    begin = time.thread_time()
    problem, scale = pose_hard_wall(scene, scene.path.steps[0], heights, TOLERANCE, 1)
    return measure.measure_load(problem, scale, solver) | {"seconds": time.thread_time() - begin}


def timed_peer(scene: Scene, heights: Array, tolerance: float) -> dict:
    """Return the CPU seconds of the peer at a tolerance, and whether our certificate accepts its pressure."""
    begin = time.thread_time()
    problem, _ = pose_hard_wall(scene, scene.path.steps[0], heights, TOLERANCE, 1)
    pressure = pressed_by_contact_mechanics(problem, tolerance, is_free=False)
    spent = time.thread_time() - begin
    accepted = np.isfinite(pressure).all() and problem.certify(problem.project(pressure))[0].met(TOLERANCE)
    return {"status": "CONVERGED" if accepted else "REFUSED", "seconds": spent}


def ratio(scene: Scene, heights: Array, solver: str) -> float:
    """Return the CPU time of a solver over that of the default one; NaN if it finds no solution."""
    measure_other = partial(timed, scene, heights, solver)
    if solver == PEER:
        accepted = (rung for rung in RUNGS if timed_peer(scene, heights, rung)["status"] == "CONVERGED")
        measure_other = partial(timed_peer, scene, heights, next(accepted, RUNGS[-1]))
    pairs = []
    for _ in range(ROUNDS):
        own, other = timed(scene, heights, DEFAULT), measure_other()
        assert own["status"] == "CONVERGED"
        if other["status"] != "CONVERGED":  # tamaas, on a contact of a single point
            return np.nan
        pairs.append(other["seconds"] / own["seconds"])
    return median(pairs)


def row(points: int, hurst_exponent: float, pressure: float, solvers: list[str]) -> list[str]:
    """Return a row of the table."""
    shares, transforms = [], []
    for seed in range(MEMBERS):
        surface = SelfAffine(
            length=1e4,
            hurst_exponent=hurst_exponent,
            long_cutoff=2500.0,
            short_cutoff=8e4 / points,
            rms_gradient=GRADIENT,
            seed=seed,
        )
        scene = Scene(HalfSpace(contact_modulus=1.0), surface, HardWall(), pressures([pressure * GRADIENT]))
        heights = scene.heights(points)
        transforms.append(timed(scene, heights, DEFAULT)["transforms"])
        shares.append([ratio(scene, heights, name) for name in solvers])
    numbers = [f"{share:.2g}" for share in np.mean(shares, axis=0)]
    return [f"{points}", f"{hurst_exponent:g}", f"{pressure:g}", f"{np.mean(transforms):.0f}", *numbers]


def main() -> None:
    """Measure all cases and put their table into the README."""
    on_one_thread()
    solvers = [name for name in OTHERS if name != "tamaas" or is_installed(name)]
    solvers += [PEER] if find_spec(PEER) else []
    header = ["points", "H", "p*", "transforms", *(f"{name} ÷ {DEFAULT}" for name in solvers)]
    rows = []
    for points, hurst_exponent, pressure in itertools.product(SIZES, (0.2, 0.8), PRESSURES):
        rows.append(row(points, hurst_exponent, pressure, solvers))
        logger.info(" ".join(rows[-1]))
    insert(README, BEGIN, markdown(header, rows), END)


if __name__ == "__main__":
    main()
