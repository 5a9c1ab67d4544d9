"""Pages of the documentation that are made from the code and from results, and formulas as MathML.

Nothing on the pages is loaded from elsewhere: browsers draw MathML themselves.
"""

import csv
import re
import shutil
import subprocess
import sys
from importlib import import_module
from pathlib import Path

from latex2mathml.converter import convert

import contactsim
from contactsim.durations import duration_text

DOCS = Path(__file__).parent
GENERATED = DOCS / "generated"
ROOT = DOCS.parent
PACKAGES = {
    "Simulate": ("single_load", "characterisation", "simulation", "observables", "paths.contact_stiffness"),
    "Scenes and load paths": ("contact",),
    "Surfaces": ("surfaces",),
    "Elastic bodies": ("elasticity",),
    "Interface": ("interface",),
    "Increments": ("paths",),
    "Results": ("solvers", "status", "errors", "dataset", "figures"),
}
"""Sections of the page of the API, and the modules whose public names stand in them; the first that fits counts."""
COMMANDS = ("new", "explain", "run", "press", "estimate", "compare", "schema", "verify")
OUTSIDE = {"../config/README.md": "generated/settings.md", "../benchmarks/README.md": "generated/benchmarks.md"}
"""Pages outside of docs/, and where they stand on the site."""


def write_generated_pages() -> None:
    """Write the pages that are made from the code and from results."""
    shutil.rmtree(GENERATED, ignore_errors=True)
    GENERATED.mkdir()
    pages = {
        "api": api_page(),
        "variables": variables_page(),
        "commands": commands_page(),
        "figures": figures_page(),
        "settings": (ROOT / "config/README.md").read_text(encoding="utf-8"),
        "benchmarks": (ROOT / "benchmarks/README.md").read_text(encoding="utf-8"),
    }
    for name, text in pages.items():
        (GENERATED / f"{name}.md").write_text(text, encoding="utf-8")
    for picture in (ROOT / "benchmarks").glob("*.png"):
        shutil.copy(picture, GENERATED)


def api_page() -> str:
    """Return the page of all public names, from their docstrings."""
    text = (
        "# API\n\n`import contactsim as cs` gives all names on this page. Modules load when a name is first used.\n\n"
    )
    waiting = dict(contactsim.PUBLIC)
    for title, modules in PACKAGES.items():
        names = [name for name, module in waiting.items() if module.startswith(modules)]
        text += f"## {title}\n\n" + "".join(map(_api_entry, names))
        waiting = {name: module for name, module in waiting.items() if name not in names}
    assert not waiting, f"names without a section: {waiting}"
    reference = import_module("contactsim.reference")
    text += f"## Reference solutions\n\n{reference.__doc__}\n\n"
    for file in sorted((ROOT / "src/contactsim/reference").glob("[a-z]*.py")):
        text += f"```{{eval-rst}}\n.. automodule:: contactsim.reference.{file.stem}\n   :members:\n```\n\n"
    return text


def _api_entry(name: str) -> str:
    """Return the entry of a public name."""
    kind = getattr(contactsim, name)
    directive = "autoclass" if isinstance(kind, type) else "autofunction" if callable(kind) else "autodata"
    options = "   :members:\n" if directive == "autoclass" else ""
    return f"```{{eval-rst}}\n.. {directive}:: contactsim.{name}\n{options}```\n\n"


def variables_page() -> str:
    """Return the table of the variables of datasets."""
    text = "# Variables of datasets\n\nEvery variable of a dataset carries `units` and `long_name`.\n"
    with (ROOT / "src/contactsim/variables.csv").open(encoding="utf-8", newline="") as file:
        table = ""
        for row in csv.DictReader(file):
            if row["table"] != table:
                table = row["table"]
                text += f"\n## {table.capitalize()}\n\n| variable | unit | meaning |\n|---|---|---|\n"
            text += f"| `{row['name']}` | {row['unit']} | {_cell(row['long_name'])} |\n"
    return text


def _cell(text: str) -> str:
    """Return a text as a cell of a table."""
    return re.sub(r"([|*_<>$])", r"\\\1", text)


def commands_page() -> str:
    """Return the page of the commands, from their own help."""
    text = "# Commands\n\n`contactsim` works in any folder.\n"
    for command in COMMANDS:
        help_text = subprocess.run(
            [sys.executable, "-c", "from contactsim.cli import main; main()", command, "--help"],
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        text += f"\n## contactsim {command}\n\n```text\n{help_text}```\n"
    return text


def figures_page() -> str:
    """Return the page of all figures with their verdicts, errors and CPU times."""
    text = (
        "# Figures\n\nAll figures of the standard tier, with what was found, errors, and the CPU time of their data.\n"
    )
    with (DOCS / "gallery/gallery.csv").open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            verdicts = [f"{float(count):.0f} {name}" for name, count in list(row.items())[3:8] if float(count or 0)]
            time = duration_text(float(row["seconds"] or 0))
            facts = [*verdicts, *filter(None, [row["errors"]]), f"{time} of CPU time"]
            text += f"\n## {row['title']}\n\n![{row['title']}](../gallery/{row['figure']}.png)\n\n{'; '.join(facts)}.\n"
    return text


def link_inside(app, name: str, source: list[str]) -> None:
    """Lead links to pages outside of docs/ to their place on the site."""
    folder = "../" * name.count("/")
    text = source[0]
    if name.startswith("generated/"):
        text = text.replace("](../docs/", "](../").replace("](damage.csv)", "](../../benchmarks/damage.csv)")
    for outside, inside in OUTSIDE.items():
        text = text.replace(f"]({folder}{outside}", f"]({folder}{inside}")
    text = text.replace("](gallery/gallery.md", "](generated/figures.md")
    source[0] = re.sub(
        r"\[([^\]]+)\]\((?:\.\./)+(?!gallery)(?:docs/)?([\w./-]*\.(?:py|csv|yaml|txt|cff)|LICENSE)\)", r"\1", text
    )


def escape_bars(app, what: str, name: str, member, options, lines: list[str]) -> None:
    """Keep bars, as in |q|, from being read as substitutions."""
    lines[:] = [line.replace("|", r"\|") for line in lines]


def visit_inline(translator, node) -> None:
    """Write a formula of a line."""
    translator.body.append(convert(node.astext(), display="inline"))
    raise import_module("docutils.nodes").SkipNode


def visit_block(translator, node) -> None:
    """Write a formula on lines of its own."""
    translator.body.append(f'<div class="math">{convert(node.astext(), display="block")}</div>')
    raise import_module("docutils.nodes").SkipNode


def setup(app) -> None:
    """Register this module as an extension."""
    app.add_html_math_renderer("mathml", (visit_inline, None), (visit_block, None))
    app.connect("source-read", link_inside)
    app.connect("autodoc-process-docstring", escape_bars)
