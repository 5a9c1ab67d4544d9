"""Cost of each effect, and change on neglecting it."""
