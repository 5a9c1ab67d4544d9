"""The gallery says of each figure what claims, datasets and costs say; docs/ shows that of the standard tier."""

from __future__ import annotations

import pandas as pd
import pytest
from PIL import Image

from contactsim import dataset
from contactsim.analysis.verdict import NOT_REPRODUCED, REPRODUCED
from contactsim.analysis.wording import printed
from contactsim.publish import gallery
from contactsim.publish.gallery import VERDICTS, figures_in_source
from contactsim.solvers.registry import SOLVERS, solver_class
from contactsim.study.plan import Plan
from contactsim.study.reading import keys_of
from support.places import ROOT

DOCS = ROOT / "docs/gallery"
OTHERS = {"effects": "Cost of effects"}


@pytest.mark.parametrize(
    ("source", "names"),
    [
        ("Section 3.3.1, Figs 3.2a, 3.2b; Section 3.4", {"fig_3_2"}),
        ("Section 4.3.2, Figs 4.5b, 4.6", {"fig_4_5", "fig_4_6"}),
        ("Eq. 3.7, Table 3.1, Section 3.2.2", {"table_3_1"}),
        ("Section 6.4.1, C to D; Fig. 6.8a", {"fig_6_8"}),
        ("Sections 3.3.1, 3.4, 7", set()),
    ],
)
def test_a_statement_belongs_to_the_figures_that_its_source_names(source, names):
    assert figures_in_source(source) == names


@pytest.fixture(scope="module")
def plan():
    return Plan.read(ROOT / "config", "quick")


@pytest.fixture(scope="module")
def shown(made, plan, tmp_path_factory):
    """The gallery of the quick tier."""
    folder, target = made / plan.results, tmp_path_factory.mktemp("gallery")
    Image.new("RGB", (1000, 500)).save(folder / "figures/effects.png")
    gallery.write_gallery(plan, folder, target, OTHERS)
    return target


@pytest.mark.slow
def test_every_row_says_what_claims_datasets_and_costs_say(shown, made, plan):
    folder = made / plan.results
    rows = pd.read_csv(shown / "gallery.csv").set_index("figure")
    assert list(rows.index) == [*plan.figures, *OTHERS]
    claims = pd.read_csv(folder / "claims/ch4.csv")
    own = claims[claims.source.str.contains(r"4\.7")]
    assert len(own) > 1
    assert {name: int(rows.loc["fig_4_7", name]) for name in VERDICTS} == {
        name: int((own.verdict == name).sum()) for name in VERDICTS
    }
    costs = pd.read_csv(folder / "costs/ch4_pull_off.csv")
    assert rows.seconds["fig_4_8"] == pytest.approx(costs.seconds.sum(), abs=0.051)
    data = dataset.load_dataset(folder / "datasets/ch3_rough_line.nc")
    error = float(data.kappa_r_grid_error.max())
    assert f"κᵣ {error:.1g}" in rows.errors["fig_3_2"]
    assert rows.data["fig_3_2"] == plan.figure_settings("fig_3_2")["data"]
    assert pd.isna(rows.errors["fig_2_2"])


@pytest.mark.slow
def test_every_variable_of_every_dataset_is_known(made, plan):
    files = sorted((made / plan.results / "datasets").glob("*.nc"))
    assert len(files) >= len(plan.studies)
    options = {name for kind in SOLVERS for name in keys_of(solver_class(kind))}
    for file in files:
        for name, item in dataset.load_dataset(file).variables.items():
            assert name in options or not item.attrs["long_name"].startswith("option "), (file.name, name)


@pytest.mark.slow
def test_pictures_are_small_and_verdicts_whole(shown, made, plan):
    every = pd.read_csv(shown / "verdicts.csv")
    counts = sum(len(pd.read_csv(made / plan.results / f"claims/{chapter}.csv")) for chapter in plan.claims)
    assert len(every) == counts
    for name in (*plan.figures, *OTHERS):
        with Image.open(shown / f"{name}.png") as picture:
            assert picture.width == gallery.WIDTH


def test_a_cell_tells_verdicts_errors_and_time():
    found = {REPRODUCED: 3, NOT_REPRODUCED: 1}
    row = {"figure": "fig_1_1", "title": "One", "errors": "grid error up to: κ 0.1", "seconds": 200.0}
    text = gallery.gallery_page(pd.DataFrame([row | dict.fromkeys(VERDICTS, 0) | found]))
    assert 'src="fig_1_1.png"' in text
    assert "3 reproduced; 1 not reproduced<br>grid error up to: κ 0.1<br>3 min 20 s of CPU time" in text


def test_words_of_the_config_are_no_html_in_the_gallery():
    row = {"figure": "fig_1_1", "title": 'a < b\n\n"><script>', "errors": "<i>", "seconds": 0.0}
    text = gallery.gallery_page(pd.DataFrame([row | dict.fromkeys(VERDICTS, 0)]))
    assert "<b>a &lt; b &quot;&gt;&lt;script&gt;</b><br><sub>&lt;i&gt;</sub>" in text
    assert "<script" not in text and "<i>" not in text


def test_the_gallery_shows_every_figure_as_the_standard_tier_made_it():
    rows = pd.read_csv(DOCS / "gallery.csv")
    assert (DOCS / "gallery.md").read_text(encoding="utf-8") == gallery.gallery_page(rows)
    plan = Plan.read(ROOT / "config", "standard")
    assert list(rows.figure[: len(plan.figures)]) == list(plan.figures)
    titles = [printed(figure.settings["title"]) for figure in plan.figures.values()]
    assert list(rows.title[: len(plan.figures)]) == titles
    assert {file.stem for file in DOCS.glob("*.png")} == set(rows.figure)


def test_the_verdicts_of_the_standard_tier_are_those_of_the_statements_in_the_config():
    every = pd.read_csv(DOCS / "verdicts.csv")
    plan = Plan.read(ROOT / "config", "standard")
    names = [name for claims in plan.claims.values() for name in claims]
    assert list(every.claim) == names
    assert gallery.counts_markdown(every) in (ROOT / "README.md").read_text(encoding="utf-8")


def test_pictures_for_the_readme_stay_small():
    files = [
        file for file in (ROOT / "docs").rglob("*") if file.is_file() and ROOT / "docs/generated" not in file.parents
    ]
    assert sum(file.stat().st_size for file in files) <= 9e6  # some seventy, 1200 px each
