"""Contact of rough and smooth elastic solids on periodic grids."""

from contactsim.api import press
from contactsim.errors import SceneError
from contactsim.march import simulate

__all__ = ["SceneError", "press", "simulate"]
