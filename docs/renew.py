"""Put gallery, pictures, verdicts and the table of κ of the standard tier into docs/, their counts into README.md.

Run `make all` and `make gallery` before.
"""

import re
import shutil
import sys
from pathlib import Path

from contactsim.publish import gallery
from contactsim.publish.factor_table import factor_table
from contactsim.publish.verdict_page import write_verdict_pages
from contactsim.study.plan import Plan

DOCS = Path(__file__).parent
RESULTS = DOCS.parent / "results/standard"
ENSEMBLES = {"lines": ("rough_line", ["rough_line_many"]), "surfaces": ("rough_surface", ["rough_surface_many"])}
"""Tables of docs/continuum.md: the study that each shows, and those with more members of the same surfaces."""
PICTURES = ("price_of_accuracy", "robustness", "effects", "overview", "trials", "effect_maps", "fig_3_2", "maps")


def between(text: str, name: str, new: str) -> str:
    """A text with what stands between two marks replaced."""
    marks = rf"(<!-- {name} -->\n).*?(<!-- end of {name} -->)"
    return re.sub(marks, lambda found: found[1] + new + found[2], text, flags=re.DOTALL)


if not (RESULTS / "gallery").is_dir():
    sys.exit(f"{RESULTS / 'gallery'} does not exist: run `make all` and `make gallery` before")
shutil.rmtree(DOCS / "gallery", ignore_errors=True)
shutil.copytree(RESULTS / "gallery", DOCS / "gallery")
write_verdict_pages(DOCS)
for name in PICTURES:
    gallery.write_thumbnail(RESULTS / f"figures/{name}.png", DOCS / f"{name}.png", width=1600)
shutil.copyfile(RESULTS / "figures/trials.csv", DOCS / "trials.csv")
readme = DOCS.parent / "README.md"
text = readme.read_text(encoding="utf-8")
text = between(text, "verdicts", (DOCS / "gallery/counts.md").read_text(encoding="utf-8"))
readme.write_text(text, encoding="utf-8")
page = DOCS / "continuum.md"
text = page.read_text(encoding="utf-8")
plan = Plan.read(DOCS.parent / "config", "standard")
for table, (study, more) in ENSEMBLES.items():
    text = between(text, table, factor_table(plan, RESULTS, study, more))
page.write_text(text, encoding="utf-8")
