"""Predictions along a path: exact for polynomials, and never far beyond states that are close together."""

from __future__ import annotations

import numpy as np
import pytest

from contactsim.paths.extrapolation import MAX_AMPLIFICATION, History


def history_of(parameters, polynomial, noise=0.0, **options):
    """A history with the values of a polynomial, and noise of changing sign."""
    history = History(**options)
    for count, parameter in enumerate(parameters):
        history.add(parameter, np.array([np.polyval(polynomial, parameter) + noise * (-1) ** count]))
    return history


@pytest.mark.parametrize("parameters", [[0.0], [0.0, 1.0], [0.0, 1.0, 2.0], [0.0, 1.0, 2.0, 3.0]])
def test_a_prediction_has_the_highest_order_at_equal_increments(parameters):
    order = len(parameters) - 1
    polynomial = np.arange(1.0, order + 2)
    history = history_of(parameters, polynomial)
    assert history.order == history.order_at(order + 1.0) == order
    expected = np.polyval(polynomial, order + 1.0) if order else history.states[-1][0]
    assert history.extrapolate(order + 1.0) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(("spacing", "order"), [(1.0, 3), (0.6, 2), (1 / 256, 1)])
def test_close_states_predict_one_far_ahead_by_a_lower_order(spacing, order):
    history = history_of([0.0, spacing, 2 * spacing, 3 * spacing], [1.0, 0.0])
    assert history.order_at(3 * spacing + 1.0) == order


def test_noise_of_the_states_is_amplified_no_further_than_is_allowed():
    parameters, noise = [0.0, 0.4, 0.8, 1.2], 1e-3
    bounded = history_of(parameters, [2.0, 1.0], noise)
    free = history_of(parameters, [2.0, 1.0], noise, max_amplification=np.inf)
    error, free_error = (abs(history.extrapolate(2.2)[0] - 5.4) for history in (bounded, free))
    assert error <= MAX_AMPLIFICATION * noise
    assert free_error > 2 * MAX_AMPLIFICATION * noise


def test_a_path_that_turns_begins_again():
    history = history_of([0.0, 1.0, 2.0], [1.0, 0.0, 0.0])
    assert history.turns_at(1.5)
    assert history.extrapolate(1.5)[0] == 4.0
    history.add(1.5, np.array([2.25]))
    assert history.order_at(1.0) == 1
