"""One measurement each: a sweep over all loads beside its transforms alone; one load with one solver beside another.

Times are CPU seconds on one thread. What is compared is timed in turns in one process, so that what else the machine
does falls on both; a ratio is the median over the rounds, a time the best.
"""

from __future__ import annotations

import resource
import signal
import time
from collections import Counter
from collections.abc import Callable
from multiprocessing import get_context

import numpy as np

from contactsim.contact.certificate import Certificate
from contactsim.contact.hard_wall import HardWallProblem, Scale
from contactsim.contact.pose_hard_wall import pose_hard_wall
from contactsim.contact.scene import Scene
from contactsim.grid import Array, Grid, TransformCounter
from contactsim.solvers.base import solve
from contactsim.solvers.registry import make_solver
from contactsim.study.plan import Plan
from contactsim.study.scenes import build_scene

CAP = 120
"""CPU seconds that one solution may take."""
LONG = 20.0
"""CPU seconds above which a solution is not repeated."""


class ByGrid(TransformCounter):
    """A counter that also keeps the number of transforms on each grid."""

    def __init__(self, finest: int) -> None:
        super().__init__(finest)
        self.counts: Counter[int] = Counter()

    def add(self, count: int, size: int) -> None:
        """Enter `count` transforms on a grid of `size` points."""
        super().add(count, size)
        self.counts[size] += count


def pose_case(plan: Plan, case: dict, loads: list[float], study: str = "rough_line") -> tuple[Scene, Array]:
    """Return the scene of a member of a study at reduced pressures `loads`, and its heights (nm)."""
    study = plan.studies[study]
    wanted = {"hurst_exponent": case["hurst_exponent"]}
    run = next(run for run in study.runs() if (run.coordinates, run.member) == (wanted, case["member"]))
    scene = build_scene(
        run.settings | {"points": case["points"], "load": {"name": "reduced_pressure", "values": loads}}
    )
    return scene, scene.heights(case["points"])


def largest_residual(certificate: Certificate) -> float:
    """Return the largest residual of a solution, in grid steps."""
    return max(certificate.max_contact_gap, certificate.penetration)


def transform_seconds(counts: dict[int, float]) -> float:
    """Return the CPU seconds of so many transforms on each grid, and of nothing else."""
    spent = 0.0
    for size, count in counts.items():
        grid, field = Grid((size,), (1.0,)), np.random.default_rng(0).standard_normal(size)
        half, pairs = grid.forward(field), max(round(count / 2), 1)
        begin = time.thread_time()
        for _ in range(pairs):
            grid.backward(grid.forward(field, out=half), out=field)
        spent += (time.thread_time() - begin) * count / (2 * pairs)
    return spent


def measure_sweep(plan: Plan, case: dict, rounds: int) -> dict:
    """Measure all loads of Fig. 3.2 with the active set, each followed by as many transforms alone."""
    least, largest = plan.figures["fig_3_2"].settings["select"]["reduced_pressure"]
    loads = [p for p in plan.studies["rough_line"].settings["load"]["values"] if least <= p <= largest]
    scene, heights = pose_case(plan, case, loads)
    method, spent, results = make_solver(case["solver"]), np.zeros((rounds, 3)), []
    for row in spent:
        results.clear()
        for step in scene.path.steps:
            begin = time.thread_time()
            problem, scale = pose_hard_wall(scene, step, heights, case["tolerance"], 1)
            problem.counter = problem.compliance.counter = ByGrid(heights.size)
            results.append(solve(method, problem, scale))
            seconds = time.thread_time() - begin
            finest = {heights.size: problem.counter.transforms}
            row += seconds, transform_seconds(finest), transform_seconds(problem.counter.counts)
    unsolved = sum(result.status.name != "CONVERGED" for result in results)
    return {
        "status": f"{unsolved} of {len(results)} not converged" if unsolved else "CONVERGED",
        "certificate": max(largest_residual(result.record.certificate) for result in results),
        "transforms": sum(result.record.transforms for result in results),
        "rounds": rounds,
        **dict(zip(("seconds", "seconds_of_transforms", "seconds_of_replay"), spent.min(axis=0), strict=True)),
        "per_transforms": np.median(spent[:, 0] / spent[:, 1]),
        "per_replay": np.median(spent[:, 0] / spent[:, 2]),
    }


def measure_load(problem: HardWallProblem, scale: Scale, name: str) -> dict:
    """Measure one load with one solver, which only its time limits."""
    result = solve(make_solver(name, budget=10**9), problem, scale)
    return {
        "status": result.status.name,
        "area": result.relative_contact_area,
        "certificate": largest_residual(result.record.certificate),
        "transforms": result.record.transforms,
    }


def measure_pair(plan: Plan, case: dict, rounds: int) -> dict:
    """Measure one load with one solver, each time after the active set, in a process with a limit on its CPU time."""
    scene, heights = pose_case(plan, case, [case["reduced_pressure"]])

    def once(name: str) -> dict:
        begin = time.thread_time()
        problem, scale = pose_hard_wall(scene, scene.path.steps[0], heights, case["tolerance"], 1)
        return measure_load(problem, scale, name) | {"seconds": time.thread_time() - begin}

    def turns() -> dict:
        once("active_set")
        cap = int(time.process_time()) + CAP
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_CPU, (cap, resource.RLIM_INFINITY))
        pairs = []
        while len(pairs) < rounds and (not pairs or pairs[-1][1]["seconds"] < LONG):
            pairs.append((once("active_set"), once(case["solver"])))
        ratio = np.median([other["seconds"] / own["seconds"] for own, other in pairs])
        fastest = min((other for _, other in pairs), key=lambda row: row["seconds"])
        return fastest | {"per_active_set": ratio, "rounds": len(pairs)}

    return run_in_child(turns) or {"status": f"not finished in {CAP} s", "seconds": CAP}


def run_in_child(task: Callable[[], dict]) -> dict | None:
    """Return the result of a task in a process of its own; None if it exceeds its CPU time."""
    receive, send = get_context("fork").Pipe(duplex=False)
    child = get_context("fork").Process(target=lambda: send.send(task()))
    child.start()
    send.close()
    try:
        return receive.recv()
    except EOFError:
        child.join()
        if child.exitcode != -signal.SIGXCPU:
            raise RuntimeError(f"the solution ended with exit code {child.exitcode}") from None
        return None
    finally:
        child.join()
