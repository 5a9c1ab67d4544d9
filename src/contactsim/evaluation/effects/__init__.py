"""What each effect costs, and what neglecting it changes."""
