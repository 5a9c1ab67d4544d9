"""The one error a user meets: bad input, said so that it can be mended.

A `SceneError` names the file (where there is one), the key, the value and what is allowed.
Numerical failure is not an error but a `Status` stored with the result.
"""

from __future__ import annotations

import math
from numbers import Real
from pathlib import PurePath

import numpy as np


class SceneError(ValueError):
    """Input that cannot be simulated.

    key: name of the offending setting; value: what was given; allowed: what would have been accepted;
    file: where it was read, if anywhere.
    """

    def __init__(self, key: str, value: object, allowed: str, file: object = None) -> None:
        self.key, self.value, self.allowed, self.file = key, value, allowed, file
        where = f"{file}: " if file is not None else ""
        super().__init__(f"{where}{key}: got {shown(value)}; allowed: {allowed}")

    def __reduce__(self) -> tuple:
        """So that it can leave a process that it came up in."""
        return SceneError, (self.key, self.value, self.allowed, self.file)

    def within(self, file: object, prefix: str = "") -> SceneError:
        """Return the same error with the file, and the section of it, in which the key was read."""
        key = f"{prefix}.{self.key}" if prefix else self.key
        return SceneError(key, self.value, self.allowed, self.file if self.file is not None else file)


def is_number(value: object) -> bool:
    """Whether a value is one finite real number; text, booleans and arrays are not."""
    return isinstance(value, Real) and not isinstance(value, bool) and math.isfinite(value)


def shown(value: object) -> str:
    """A short form of any value for a message: long ones but paths are cut, arrays give their shape."""
    if isinstance(value, PurePath):
        return repr(str(value))
    shape = getattr(value, "shape", None)
    if shape:
        return f"array of shape {tuple(shape)}"
    with np.printoptions(legacy="1.25"):  # numbers of numpy as plain ones, also within lists
        text = repr(value)
    return text if len(text) <= 80 else text[:77] + "..."
