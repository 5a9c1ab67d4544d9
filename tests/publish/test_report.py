"""The report is one file that needs nothing else, and says what the claims, datasets and costs say."""

from __future__ import annotations

import base64
import html
import json
import re

import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure

from contactsim import dataset
from contactsim.analysis.rounding import number_cells
from contactsim.analysis.verdict import CONDITION, NOT_REPRODUCED
from contactsim.analysis.wording import printed
from contactsim.evaluation.robustness.survey import read_robustness
from contactsim.figures.vector import write_vector
from contactsim.publish import report
from contactsim.publish.gallery import VERDICTS
from contactsim.study.figure_plan import PICTURE_ENDINGS
from contactsim.study.plan import Plan
from support.browser import CHROMIUM, browser
from support.places import ROOT

pytestmark = pytest.mark.slow

HELPERS = """
const wait = async test => {
  for (let count = 0; count < 200 && !test(); count++) await new Promise(done => setTimeout(done, 25));
  return test();
};
const rows = () => [...document.querySelectorAll("#statements tbody tr")].filter(row => row.clientHeight > 0);
const column = name => [...document.querySelectorAll("#statements thead th")].find(one => one.textContent === name);
"""


@pytest.fixture(scope="module")
def plan():
    return Plan.read(ROOT / "config", "quick")


@pytest.fixture(scope="module")
def page(made, plan):
    """The page of the quick tier, with a stand-in for the map of stability."""
    folder = made / plan.results
    figure = Figure(figsize=(6, 3))
    figure.subplots().plot([0, 1], [0, 1])
    figure.savefig(folder / "figures/stability.png")
    write_vector(figure, folder / "figures/stability.svg")
    return report.page_text(report.collect_results(plan, json.loads(json.dumps(report_settings(plan))), folder))


def report_settings(plan):
    others = {"stability": {"stability": read_robustness(ROOT / "config", plan)}, "effects": {}}
    return report.report_settings(plan, others)


@pytest.fixture(scope="module")
def every(made, plan):
    folder = made / plan.results / "claims"
    return pd.concat([pd.read_csv(folder / f"{chapter}.csv") for chapter in plan.claims], ignore_index=True)


def test_every_figure_and_study_stands_on_the_page_with_its_command(page, plan):
    for name, figure in plan.figures.items():
        assert f'id="{name}"' in page
        assert f"make {name} TIER=quick" in page
        assert html.escape(printed(figure.settings["title"])) in page
    for name in plan.studies:
        assert f'id="study-{name}"' in page


def test_every_statement_stands_there_once_with_its_verdict_value_and_errors(page, every):
    table = page[page.index('id="statements"') : page.index("</table>", page.index('id="statements"'))]
    rows = re.findall(r'<tr id="[^"]+" class="row-(\w+)[^"]*">(.*?)</tr>', table, re.DOTALL)
    assert len(rows) == len(every) > 100
    for (mark, text), claim in zip(rows, every.to_dict("records"), strict=True):
        assert mark == report.ROW_MARKS[claim["verdict"]]
        cells = [html.unescape(cell) for cell in re.findall(r"<td.*?>(.*?)</td>", text, re.DOTALL)]
        assert cells[0] == claim["source"]
        assert cells[1] == printed(claim["statement"])
        assert cells[5:8] == number_cells(claim)
        assert claim["verdict"] in cells[2]
        assert (claim["verdict"] == CONDITION) <= (str(claim["condition"]) in cells[2])


def test_the_counts_are_those_of_the_verdicts(page, every, plan):
    rows = re.findall(r"<tr><td>(Chapter \d|all)</td>((?:<td class=\"number\">\d+</td>)+)", page)
    counts = {name: [int(cell) for cell in re.findall(r">(\d+)<", cells)] for name, cells in rows}
    assert counts["all"] == [int((every.verdict == verdict).sum()) for verdict in VERDICTS]
    parts = [found for name, found in counts.items() if name != "all"]
    assert np.sum(parts, axis=0).tolist() == counts["all"]
    assert len(parts) == len(plan.claims)


def test_a_study_tells_its_cost_its_unconverged_solutions_and_its_settings(page, made, plan):
    folder = made / plan.results
    costs = pd.read_csv(folder / "costs/ch4_indentation.csv")
    assert f"{costs.run.nunique()} runs, {costs.transforms.sum():.3g} transforms" in page
    part = page[page.index('<details id="study-indentation">') :]
    part = html.unescape(part[: part.index("</details>")])
    settings = dataset.settings_of(dataset.load_dataset(folder / "datasets/ch4_indentation.nc"))
    assert f"<th>points</th><td>{settings['points']}</td>" in part
    assert "<td>{kind: cylinder, length: 10000.0, radius: 25000.0}</td>" in part
    assert "solutions unconverged" in part
    assert "make indentation TIER=quick" in part


def test_the_page_needs_nothing_but_itself_and_its_links_lead_somewhere(page):
    assert all(one.startswith("data:") for one in re.findall(r'src="([^"]*)"', page))
    used = re.findall(r'href="([^"]*)"', page)
    assert not [one for one in used if ":" in one and not one.startswith("data:")]
    assert not re.search(r"@import|url\(|fetch\(|XMLHttpRequest", re.sub(r'"data:[^"]*"', "", page))
    places = re.findall(r' id="([^"]+)"', page)
    assert len(places) == len(set(places))
    assert {one[1:] for one in used if one.startswith("#")} <= set(places)


def test_a_film_stands_with_its_figure_as_its_file_has_it(page, made, plan):
    films = [name for name, figure in plan.figures.items() if figure.settings["film"] is not None]
    assert page.count('<details class="film">') == len(films) >= 4
    for name in films:
        section = page[page.index(f'<h3 id="{name}">') :]
        section = section[: section.index("</section>")]
        file = (made / plan.results / f"figures/{name}.gif").read_bytes()
        assert f'src="data:image/gif;base64,{base64.b64encode(file).decode()}"' in section
        assert f'href="figures/{name}.gif">film (GIF)</a>' in section


def test_the_page_is_small_enough_to_send(page):
    assert len(page.encode()) <= 10e6


def test_other_settings_have_another_digest(plan):
    assert report_settings(plan) == report_settings(plan)
    assert report_settings(Plan.read(ROOT / "config", "standard"))["data"] != report_settings(plan)["data"]


@pytest.fixture(scope="module")
def shown(page, made, plan, tmp_path_factory):
    """The page in a browser, as the file that lies in the folder of results."""
    if CHROMIUM is None:
        pytest.skip("needs Chromium")
    file = made / plan.results / "report.html"
    file.write_text(page, encoding="utf-8")
    with browser(tmp_path_factory.mktemp("browser")) as window:

        def open_page(**size):
            window.open(file.as_uri(), **size)
            window.evaluate(f"globalThis.eval({json.dumps(HELPERS)}.replaceAll('const ', 'var '))")
            return window

        yield open_page


@pytest.mark.parametrize(("width", "dark"), [(1400, False), (400, True)])
def test_a_browser_shows_all_of_it_without_errors_or_requests(shown, width, dark):
    window = shown(width=width, dark=dark)
    script = """
        document.querySelectorAll("details").forEach(one => { one.open = true; });
        const seen = image => image.complete && image.naturalWidth > 0 && image.clientWidth > 100;
        const images = [...document.querySelectorAll("main img")];
        await wait(() => images.every(seen));
        return {
            page: document.documentElement.scrollWidth,
            unseen: images.filter(image => !seen(image)).map(one => one.alt),
            theme: document.documentElement.dataset.theme,
            captions: [...document.querySelectorAll("figcaption")].filter(one => one.clientHeight === 0).length,
        };
    """
    found = window.evaluate(script)
    assert found == {"page": width, "unseen": [], "theme": "dark" if dark else "light", "captions": 0}
    assert {url.partition(":")[0] for url in window.requests} <= {"file", "data", "blob"}
    assert sum(url.startswith("file") for url in window.requests) == 1
    assert window.errors == []


@pytest.mark.parametrize("still", [False, True])
def test_films_play_unless_the_system_asks_for_less_motion(shown, still):
    window = shown(width=1400, still=still)
    films = "[...document.querySelectorAll('.film')]"
    assert window.evaluate(f"return {films}.every(one => one.open === {json.dumps(not still)});")
    script = f"""
        const film = {films}[0];
        film.open = true;
        await wait(() => film.querySelector("img").checkVisibility());
        film.querySelector("summary").click();
        await wait(() => !film.open);
        return film.querySelector("img").checkVisibility();
    """
    assert window.evaluate(script) is False
    assert window.errors == []


def test_statements_are_filtered_and_sorted(shown, every):
    window = shown(width=1400)
    script = "document.querySelector('[data-show=no]').click(); return rows().map(row => row.className.trim());"
    assert window.evaluate(script) == ["row-no"] * int((every.verdict == NOT_REPRODUCED).sum())
    script = """
        document.querySelector('[data-show=""]').click();
        column("found").click();
        await wait(() => column("found").hasAttribute("aria-sort"));
        await new Promise(done => setTimeout(done, 100));
        return rows().map(row => row.cells[5].dataset.sort).filter(text => text !== "").map(Number);
    """
    values = window.evaluate(script)
    assert values == sorted(every.value.dropna(), reverse=True)
    assert window.errors == []


@pytest.mark.parametrize("width", [1400, 400])
def test_the_search_leads_to_a_statement_even_if_it_is_filtered_out(shown, every, plan, width):
    window = shown(width=width)
    claim = every[(every.verdict != NOT_REPRODUCED) & every.claim.isin(plan.claims["ch4"])].iloc[0]
    script = f"""
        document.querySelector("[data-show=no]").click();
        const field = document.getElementById("search");
        field.value = {json.dumps(claim.statement.upper())};
        field.dispatchEvent(new Event("input"));
        const link = document.querySelector("#hits a[href='#ch4-{claim.claim}']");
        link.click();
        const row = document.getElementById("ch4-{claim.claim}");
        await wait(() => row.clientHeight > 0);
        const box = row.getBoundingClientRect();
        return box.top < innerHeight && box.bottom > 0;
    """
    assert window.evaluate(script)
    assert window.evaluate("field = document.getElementById('search'); field.value = 'no such words';"
                           "field.dispatchEvent(new Event('input'));"
                           "return document.getElementById('found').textContent;") == "0 found"  # fmt: skip


@pytest.mark.parametrize("width", [1400, 400])
def test_a_figure_tells_values_with_errors_and_zooms(shown, made, plan, width):
    window = shown(width=width)
    script = """
        const image = document.querySelector("img[data-name=fig_3_2]");
        image.scrollIntoView({block: "center"});
        await wait(() => image.src.startsWith("blob:"));
        const point = shown.get(image).curves.map((curve, index) => [curve, index])
            .find(([curve]) => curve.y[0].includes("±"))[0];
        const frame = pictureFrame(image, shown.get(image).size);
        return [frame.left + frame.scale * point.places[0][0], frame.top + frame.scale * point.places[0][1]];
    """
    place = window.evaluate(script)
    window.move(*place)
    told = window.evaluate("await wait(() => !tip.hidden); return tip.textContent;")
    table = pd.read_csv(made / plan.results / "figures/fig_3_2.csv")
    areas = {f"{value:.4g} ± " for value in table.filter(regex="relative_contact_area.*_mean").to_numpy().ravel()}
    assert any(text in told for text in areas), told
    script = """
        document.querySelector("img[data-name=fig_3_2]").click();
        await wait(() => document.getElementById("large").open);
        const large = document.querySelector("dialog img");
        await wait(() => large.complete);
        return large.getBoundingClientRect().width;
    """
    before = window.evaluate(script)
    for _ in range(4):
        window.turn_wheel(width / 2, 400, -300)
    grown = (
        "const large = document.querySelector('dialog img'); const size = () => large.getBoundingClientRect().width;"
    )
    assert window.evaluate(grown + f"await wait(() => size() > 1.2 * {before}); return size();") > 1.2 * before
    window.evaluate("document.getElementById('back').click();")
    assert window.evaluate("return document.getElementById('large').open;") is False
    assert window.errors == []


def test_links_lead_to_the_files_of_figures_and_datasets(page, made, plan):
    files = {one for one in re.findall(r'href="([^"#]+)"', page) if not one.startswith("data:")}
    assert {f"figures/fig_3_2.{ending}" for ending in PICTURE_ENDINGS} <= files
    assert "datasets/ch4_indentation.nc" in files
    folder = made / plan.results
    stand_in = {f"figures/stability.{kind}" for kind in ("csv", "pdf")}
    assert {one for one in files if not (folder / one).is_file()} <= stand_in


def test_the_page_stays_small(page):
    assert len(page.encode()) < 10e6


def test_the_picture_of_the_stages_is_part_of_the_page(page):
    part = page[page.index("<h3>Stages</h3>") :]
    stages = re.findall(r'font-weight="600">([^<]+)</text>', part)
    assert {"config", "runs", "datasets", "figures", "claims", "report"} <= {*stages}
