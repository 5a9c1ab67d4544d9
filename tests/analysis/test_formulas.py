"""Equations as printed: the exact numbers that claims use, against other ways to the same numbers."""

from __future__ import annotations

import numpy as np
import pytest

from contactsim.analysis import formulas
from contactsim.analysis.claims import judge_claims
from contactsim.analysis.verdict import FINDING, NOT_REPRODUCED, REPRODUCED
from contactsim.elasticity.layer import Layer
from contactsim.errors import InputError
from contactsim.reference import adhesion
from contactsim.study.claim_plan import read_claim

CASES = [(0.1, 0.3), (1.0, 0.1), (1.0, 0.45), (5.0, 0.3)]
CLAIM = {"source": "Eq. 0", "statement": "It is 1.", "rationale": "A test.", "formula": "half_space_scalar"}


def judged(**changes):
    """The row of a claim on a formula."""
    settings = read_claim("test", CLAIM | changes, "ch2.yaml", {}).settings
    return judge_claims({"test": settings}, {}).iloc[0]


@pytest.mark.parametrize(("depth", "ratio"), CASES)
def test_the_exact_stiffness_of_a_slab_with_one_surface_held_is_that_of_a_layer(depth, ratio):
    uniaxial = (1 - ratio) ** 2 / (1 - 2 * ratio)  # C11 at E* = 1
    matrix = uniaxial * formulas.exact_slab_stiffness(depth, ratio)[2:, 2:]
    layer = Layer(1.0, ratio, depth).coupled_stiffness(np.ones(1))
    assert [matrix[1, 1].real, matrix[0, 0].real] == pytest.approx(layer.diagonal[:, 0].tolist(), rel=1e-9)
    assert abs(matrix[0, 1]) == pytest.approx(abs(layer.coupling[0]), rel=1e-7)


@pytest.mark.parametrize("moved", [[1, 0, 1, 0], [0, 1, 0, 1]])
def test_a_body_moved_as_a_whole_stores_energy_in_the_printed_matrix_alone(moved):
    elements, moved = formulas.printed_elements(1e-3, 0.3), np.array(moved)
    matrices = [formulas.slab_stiffness(elements, is_printed) for is_printed in (True, False)]
    printed, meant = ((moved @ matrix @ moved).real / np.abs(matrix).max() for matrix in matrices)
    assert printed > 0.1
    assert meant < 1e-5


@pytest.mark.parametrize("stiffness", [0.01, 1.0, 50.0])
def test_the_iteration_grows_or_decays_as_the_sign_of_its_damping_says(stiffness):
    def change(sign):
        """The factor per iteration of the size of a wave, over many of them."""
        before, now, sizes = 0.0, 1.0, []
        for _ in range(4000):
            speed = now - before
            before, now = now, 2 * now - before + (-stiffness * now + sign * speed) * formulas.TIME_STEP**2
            sizes.append(np.hypot(np.sqrt(stiffness) * now, speed / formulas.TIME_STEP))
        return (sizes[-1] / sizes[2000]) ** (1 / 1999)

    assert change(1.0) > formulas.verlet_growth(1.0) - 1e-3 > 1.0035
    assert change(-1.0) < 1


def test_the_derivative_of_the_energy_points_along_the_displacement():
    matrix = formulas.slab_stiffness(formulas.printed_elements(1.0, 0.3), is_printed=False)[3, 3].real
    energy = [matrix * size**2 / 2 for size in (1.0, 1.0 + 1e-6)]
    assert formulas.restoring_work(1.0) == pytest.approx((energy[1] - energy[0]) / 1e-6 / (2 * energy[0]), rel=1e-5)
    assert formulas.restoring_work(-1.0) == -formulas.restoring_work(1.0)


@pytest.mark.parametrize("ratio", [0.1, 0.5, 1.0])
def test_what_remains_of_xu_and_needlemans_normal_traction_follows_from_their_potential(ratio):
    def potential(opening, slip):
        """Xu and Needleman's potential over φn with r = 0."""
        free = 0.0  # r
        shear = np.exp(-(slip**2))
        failed = (1 - free + opening) * (1 - ratio) / (free - 1)
        return 1 + np.exp(-opening) * (failed - (ratio + (free - ratio) / (free - 1) * opening) * shear)

    opening = np.linspace(0.0, 12.0, 4001)
    tractions = {slip: np.gradient(potential(opening, slip), opening)[1:-1] for slip in (0.0, 0.7, 20.0)}
    for slip, traction in tractions.items():
        assert np.allclose(traction, adhesion.xu_needleman_normal(opening[1:-1], slip, ratio), atol=1e-5)
    remainder = tractions[20.0].max() / tractions[0.0].max()
    assert remainder == pytest.approx(formulas.xu_needleman_remainder(ratio), abs=1e-5)


def test_xu_and_needlemans_law_leaves_nothing_for_one_ratio_of_works():
    ratio = formulas.xu_needleman_work_ratio()
    assert ratio == pytest.approx(1.0, abs=1e-9)
    assert formulas.xu_needleman_remainder(ratio) == pytest.approx(0.0, abs=1e-9)
    opening = np.linspace(0.1, 5.0, 50)
    below, above = (adhesion.xu_needleman_normal(opening, formulas.COMPLETE_SHEAR, c) for c in (0.9, 1.1))
    assert below.min() > 0 > above.max()


@pytest.mark.parametrize("name", formulas.FORMULAS)
def test_each_formula_gives_a_number(name):
    assert np.isfinite(formulas.FORMULAS[name]())


def test_a_claim_on_a_formula_has_no_error():
    row = judged(expect=1.0, tolerance=0.001)
    assert (row.verdict, row.grid_error, row.ensemble_error) == (REPRODUCED, 0.0, 0.0)
    assert judged(at_most=0.5, neutral=0.0).verdict == NOT_REPRODUCED
    halved = judged(at_most=1.5, neutral=0.0)
    assert (halved.verdict, halved.verdict_half) == (REPRODUCED, NOT_REPRODUCED)


def test_a_finding_may_be_a_formula():
    settings = read_claim("test", CLAIM, "ch2.yaml", {}, "findings").settings
    row = judge_claims({"test": settings}, {}).iloc[0]
    assert (row.verdict, row.value) == (FINDING, pytest.approx(1.0))


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"at_most": 1.0}, "neutral"),
        ({"expect": 1.0, "tolerance": 0.1, "study": "flat"}, "study"),
        ({"expect": 1.0, "tolerance": 0.1, "quantity": "kappa"}, "quantity"),
        ({"expect": 1.0, "tolerance": 0.1, "formula": "none"}, "formula"),
        ({}, "expect"),
    ],
)
def test_a_claim_on_a_formula_has_a_band_and_no_study(changes, key):
    with pytest.raises(InputError, match=key):
        read_claim("test", CLAIM | changes, "ch2.yaml", {})
