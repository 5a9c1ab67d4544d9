"""Durations in words."""


def duration_text(seconds: float) -> str:
    """Return a duration as text: two digits below a minute, else one or two units."""
    whole = round(seconds)
    if whole < 60:
        return f"{float(f'{seconds:.2g}'):g} s"
    minutes, rest = divmod(whole, 60)
    if minutes < 10:
        return f"{minutes} min {rest} s" if rest else f"{minutes} min"
    hours, minutes = divmod(round(seconds / 60), 60)
    if hours == 0:
        return f"{minutes} min"
    return f"{hours} h {minutes} min" if minutes else f"{hours} h"
