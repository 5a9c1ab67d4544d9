"""The report is one file that needs nothing else, and says what the claims, datasets and costs say."""

from __future__ import annotations

import html
import json
import re
import shutil
import subprocess

import numpy as np
import pandas as pd
import pytest
from PIL import Image

from contactsim import dataset
from contactsim.analysis.rounding import number_cells
from contactsim.analysis.verdict import CONDITION, NOT_REPRODUCED
from contactsim.evaluation.robustness.survey import read_robustness
from contactsim.publish import report
from contactsim.publish.gallery import VERDICTS
from contactsim.study.plan import Plan
from support.places import ROOT

pytestmark = pytest.mark.slow

BROWSER = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
QUIET = """--headless --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking
--disable-component-update --disable-sync --hide-scrollbars --virtual-time-budget=20000""".split()
OWN = re.compile(r"//([\w.-]+\.)?(google|googleapis|gstatic)\.com|^chrome")
"""What Chromium asks for by itself."""
PROBE = """
<script>
addEventListener("load", () => {
  const shown = image => image.complete && image.naturalWidth > 0 && image.clientWidth > 100;
  const links = [...document.querySelectorAll("a")].map(link => link.getAttribute("href"));
  const missing = links.filter(link => !document.getElementById(link.slice(1)));
  const link = document.querySelector('a[href="#study-indentation"]');
  const study = document.getElementById("study-indentation");
  const closed = !study.open;
  link.click();
  const opened = closed && study.open;
  document.querySelectorAll("details").forEach(one => one.open = true);
  document.querySelector("[data-show=no]").click();
  const rows = [...document.querySelectorAll("#statements tr[class]")].filter(row => row.clientHeight > 0);
  const figure = document.querySelector("figure img");
  figure.click();
  const full = figure.clientWidth;
  figure.click();
  document.querySelector('a[href="#fig_4_7"]').click();
  const place = document.getElementById("fig_4_7").getBoundingClientRect().top;
  const asked = performance.getEntriesByType("resource").map(one => one.name).filter(name => !name.startsWith("data:"));
  const found = {
    width: innerWidth, page: document.documentElement.scrollWidth, missing, full, opened, place, asked,
    errors: window.told,
    images: document.images.length, unseen: [...document.images].filter(image => !shown(image)).map(one => one.alt),
    rows: rows.map(row => row.className),
    captions: [...document.querySelectorAll("figcaption")].map(caption => caption.clientHeight),
  };
  document.body.innerHTML = "";
  document.body.append(Object.assign(document.createElement("pre"), {id: "found", textContent: JSON.stringify(found)}));
});
</script>
"""
LISTEN = """
<script>window.told = []; addEventListener("error", event => window.told.push(String(event.message)), true);
addEventListener("unhandledrejection", event => window.told.push(String(event.reason)));
for (const kind of ["error", "warn"]) console[kind] = text => window.told.push(String(text));</script>
"""


@pytest.fixture(scope="module")
def plan():
    return Plan.read(ROOT / "config", "quick")


@pytest.fixture(scope="module")
def page(made, plan):
    """The page of the quick tier, with a stand-in for the map of stability."""
    folder = made / plan.results
    Image.fromarray(np.arange(40000, dtype=np.uint8).reshape(100, 400)).save(folder / "figures/stability.png")
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
        assert html.escape(figure.settings["title"]) in page
    for name in plan.studies:
        assert f'id="study-{name}"' in page


def test_every_statement_stands_there_once_with_its_verdict_value_and_errors(page, every):
    table = page[page.index('id="statements"') : page.index("</table>", page.index('id="statements"'))]
    rows = re.findall(r'<tr class="row-(\w+)">(.*?)</tr>', table, re.DOTALL)
    assert len(rows) == len(every) > 100
    for (mark, text), claim in zip(rows, every.to_dict("records"), strict=True):
        assert mark == report.ROW_MARKS[claim["verdict"]]
        cells = [html.unescape(cell) for cell in re.findall(r"<td.*?>(.*?)</td>", text, re.DOTALL)]
        assert cells[0] == claim["source"]
        assert cells[1] == claim["statement"].replace("κ_r", "κᵣ").replace("p_r*", "pᵣ*")
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
    used = re.findall(r'(?:src|href)="([^"]*)"', page)
    assert all(one.startswith(("#", "data:")) for one in used)
    assert not re.search(r"@import|url\(|fetch\(|XMLHttpRequest", re.sub(r'"data:[^"]*"', "", page))
    places = re.findall(r'id="([^"]+)"', page)
    assert len(places) == len(set(places))
    assert {one[1:] for one in used if one.startswith("#")} <= set(places)


def test_other_settings_have_another_digest(plan):
    assert report_settings(plan) == report_settings(plan)
    assert report_settings(Plan.read(ROOT / "config", "standard"))["data"] != report_settings(plan)["data"]


@pytest.mark.skipif(BROWSER is None, reason="needs Chromium")
@pytest.mark.parametrize("width", [1400, 500])
def test_a_browser_shows_all_of_it_without_errors_or_requests(page, every, tmp_path, width):
    text = page.replace("<head>", "<head>" + LISTEN, 1).replace("</body>", PROBE + "</body>", 1)
    (tmp_path / "page.html").write_text(text, encoding="utf-8")
    log = tmp_path / "net.json"
    options = [f"--user-data-dir={tmp_path / 'user'}", f"--window-size={width},900", f"--log-net-log={log}"]
    command = [BROWSER, *QUIET, *options, "--dump-dom", (tmp_path / "page.html").as_uri()]
    told = subprocess.run(command, capture_output=True, text=True, timeout=120, check=True).stdout
    found = json.loads(html.unescape(re.search(r'<pre id="found">(.*?)</pre>', told, re.DOTALL)[1]))
    assert found["errors"] == []
    assert found["missing"] == []
    assert found["unseen"] == []
    assert found["images"] == page.count("<img ")
    assert found["width"] == width
    assert found["page"] <= width, "nothing but tables scrolls sideways"
    assert found["full"] == width
    assert found["rows"] == ["row-no"] * int((every.verdict == NOT_REPRODUCED).sum())
    assert all(height > 0 for height in found["captions"])
    assert found["opened"]
    assert -5 < found["place"] < 100, "a link leads to its figure"
    assert found["asked"] == []
    urls = re.findall(r'"url":"(\w+://[^"/]*)', log.read_text(encoding="utf-8"))
    assert {url for url in urls if not OWN.search(url)} <= {"file://"}


def test_the_picture_of_the_stages_is_part_of_the_page(page):
    part = page[page.index("<h3>Stages</h3>") :]
    stages = re.findall(r'font-weight="600">([^<]+)</text>', part)
    assert {"config", "runs", "datasets", "figures", "claims", "report"} <= {*stages}
