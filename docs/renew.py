"""Put gallery, pictures and the table of κ of the standard tier into docs/, its verdicts into README.md.

Run `make all` and `make gallery` before.
"""

import re
import shutil
from pathlib import Path

import xarray as xr

from contactsim.analysis.quantities import SECOND_ESTIMATORS, resolves_edges
from contactsim.analysis.wording import rounded_texts
from contactsim.dataset import load_dataset
from contactsim.publish import gallery

DOCS = Path(__file__).parent
RESULTS = DOCS.parent / "results/standard"
LARGEST_PRESSURE = 0.1
"""Largest p* of the thesis."""
ENSEMBLES = {"lines": "rough_line", "surfaces": "rough_surface"}
"""Tables of docs/continuum.md, and the studies that they show."""
PICTURES = ("overview", "trials", "effect_maps", "fig_3_2", "maps")


def between(text: str, name: str, new: str) -> str:
    """A text with what stands between two marks replaced."""
    marks = rf"(<!-- {name} -->\n).*?(<!-- end of {name} -->)"
    return re.sub(marks, lambda found: found[1] + new + found[2], text, flags=re.DOTALL)


def factor_text(data: xr.Dataset, name: str) -> str:
    """Return the mean of a corrected factor with its standard error and its grid error."""
    value, second = data[f"{name}_mean"].item(), data[f"{SECOND_ESTIMATORS[name]}_mean"].item()
    grid = abs(data[f"{name}_grid_change"].item())
    grid = max(grid, abs(second - value)) if resolves_edges(data) else grid
    return " ± ".join(rounded_texts(value, data[f"{name}_standard_error"].item(), grid))


def factor_table(data: xr.Dataset) -> str:
    """Return κ and κ_r of an ensemble without the first-order error of the grid as a Markdown table."""
    exponents = data.hurst_exponent.values
    heads = [f"{symbol}, H = {hurst:g}" for symbol in ("κ", "κ_r") for hurst in exponents]
    lines = [f"| p* | {' | '.join(heads)} |", "|---" * (len(heads) + 1) + "|"]
    for pressure in data.reduced_pressure.values[data.reduced_pressure.values <= LARGEST_PRESSURE * (1 + 1e-9)]:
        parts = [data.sel(reduced_pressure=pressure, hurst_exponent=hurst) for hurst in exponents]
        cells = [factor_text(part, name) for name in ("kappa_corrected", "kappa_r_corrected") for part in parts]
        lines.append(f"| {pressure:g} | {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


shutil.rmtree(DOCS / "gallery", ignore_errors=True)
shutil.copytree(RESULTS / "gallery", DOCS / "gallery")
for name in PICTURES:
    gallery.write_thumbnail(RESULTS / f"figures/{name}.png", DOCS / f"{name}.png", width=1600)
shutil.copyfile(RESULTS / "figures/trials.csv", DOCS / "trials.csv")
readme = DOCS.parent / "README.md"
text = readme.read_text(encoding="utf-8")
text = between(text, "verdicts", (DOCS / "gallery/counts.md").read_text(encoding="utf-8"))
readme.write_text(text, encoding="utf-8")
page = DOCS / "continuum.md"
text = page.read_text(encoding="utf-8")
for table, study in ENSEMBLES.items():
    text = between(text, table, factor_table(load_dataset(RESULTS / f"datasets/{study}.nc")))
page.write_text(text, encoding="utf-8")
