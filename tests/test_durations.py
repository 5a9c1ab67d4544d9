from __future__ import annotations

import pytest

from contactsim.durations import duration_text


@pytest.mark.parametrize(
    ("seconds", "text"),
    [
        (0, "0 s"),
        (0.0853, "0.085 s"),
        (9.96, "10 s"),
        (59.4, "59 s"),
        (59.6, "1 min"),
        (61, "1 min 1 s"),
        (180, "3 min"),
        (599.6, "10 min"),
        (3595, "1 h"),
        (3725, "1 h 2 min"),
        (36000, "10 h"),
    ],
)
def test_a_duration_has_one_or_two_units(seconds, text):
    assert duration_text(seconds) == text
