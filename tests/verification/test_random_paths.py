"""Random paths of smooth laws, judged by equations that are written once more; thousands are in the benchmarks."""

from __future__ import annotations

import sys
from dataclasses import replace

import numpy as np
import pytest

from contactsim import simulate
from contactsim.status import Status
from support.places import ROOT

sys.path.insert(0, str(ROOT / "benchmarks"))

import random_paths

ONCE_WRONG = [12, 57, 60, 80, 107, 108, 137, 365, 590, 624, 757, 895]
"""Scenes whose states were once called converged and were not, or that crashed, or never ended."""


@pytest.mark.parametrize("number", [*range(30, 46), *ONCE_WRONG])
def test_what_is_called_converged_is_an_equilibrium_and_stable(number):
    found = {name for _, name, _, _ in random_paths.judge(number)}
    assert found <= {"right", "right, some unsolved", "refused"}


def test_the_judge_sees_every_kind_of_wrong_state():
    case = random_paths.draw_case(11)
    data = simulate(case.scene, **case.options)
    place, state = next(iter(random_paths.solved_states(case, data)))
    heights, unit = data.heights.values, case.scene.laws[0].normal_length

    def errors(equations=case.equations, **changes):
        changed = {name: state[name] + value for name, value in changes.items()}
        return equations.judge(state.assign(changed), place, heights)

    assert max(errors().values()) <= 1
    wave = 1e-3 * np.cos(np.arange(heights.size))
    assert errors(normal_gap=unit * wave)["normal law"] > 100
    assert errors(normal_traction=case.equations.interface.strength * wave)["normal law"] > 100
    assert errors(approach=1e-3 * unit)["approach"] > 100
    assert errors(normal_gap=np.nan) == {"finite": np.inf}
    softer = [(kind, 0.9 * modulus, *rest) for kind, modulus, *rest in case.bodies]
    assert errors(replace(case.equations, bodies=softer))["equilibrium"] > 1


def test_surfaces_that_slip_on_and_on_are_said_not_to_rest():
    case = random_paths.draw_case(80)
    data = simulate(case.scene, **case.options)
    moving = data.status.values == Status.NO_REST.value[0]
    assert moving.any()
    assert float(data.transforms.max()) < 1e5
    assert np.isnan(data.normal_gap.values[-1]).all()
