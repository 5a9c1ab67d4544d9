"""What accuracy costs: what is solved and what is forecast, and the figure."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from contactsim import dataset
from contactsim.evaluation.work_precision import prices
from contactsim.evaluation.work_precision.prices import (
    PriceJob,
    measure_price,
    price_job,
    prices_figure_job,
    read_prices,
)
from contactsim.figures.diagnostics import prices as price_figure
from contactsim.study.figure_plan import PICTURE_ENDINGS
from contactsim.study.plan import Plan
from support.cases import refused
from support.places import ROOT

PLAN = Plan.read(ROOT / "config", "quick")
PRICES = read_prices(ROOT / "config", PLAN)


def measure(name, **changes):
    """Measure a scene of the quick tier with other errors or another limit."""
    settings = json.loads(json.dumps(price_job(PRICES, name)["settings"]))
    return measure_price(replace(PriceJob.from_settings(settings), **changes))


@pytest.fixture(scope="module")
def cylinder():
    return measure("cylinder", errors=[0.1, 0.03, 0.01], limit=1e6)


def test_errors_are_asked_for_from_the_largest_on():
    job = price_job(replace(PRICES, errors=[0.01, 0.1, 0.03]), "cylinder")
    assert job["settings"]["errors"] == [0.1, 0.03, 0.01]


def test_a_scene_is_solved_to_each_error(cylinder):
    data, spent = cylinder
    assert data.requested_error.values.tolist() == [0.1, 0.03, 0.01]
    assert len(spent["seconds"]) == 3
    reached = data.accuracy_reached.values == 1
    assert reached.any()
    assert np.all(data.predicted_error.values[reached] <= data.requested_error.values[reached])
    assert np.all(np.diff(data.predicted_units.values) >= 0)
    assert float(data.thesis_error) > 0


def test_what_would_take_too_long_is_forecast_and_not_solved():
    data, spent = measure("rough_line", errors=[0.1, 0.01], limit=1.0)
    assert spent["seconds"] == []
    assert set(data.accuracy_reached.values) == {-1}
    assert np.all(data.predicted_units.values > 1)


def test_an_adhesive_surface_is_forecast_too_and_a_run_that_took_long_is_the_last(monkeypatch):
    monkeypatch.setattr(prices, "_predicted_units", lambda setup, error: 0.0)
    data, spent = measure("adhesive_sphere", errors=[0.3, 0.1], limit=1.0)
    assert len(spent["seconds"]) == 1
    assert data.accuracy_reached.values[1] == -1
    assert np.isnan(data.thesis_error)


def draw(scenes, folder, told):
    """Draw the figure of scenes, (data, spent) by name, with files in the order of their names; return its table."""
    files = {"data": [], "costs": []}
    for name, (data, spent) in sorted(scenes.items()):
        dataset.write(dataset.stamp(data, "prices", {}, "source"), folder / f"{name}.nc")
        (folder / f"{name}.json").write_text(json.dumps(spent))
        for kind, path in zip(files, (folder / f"{name}.nc", folder / f"{name}.json"), strict=True):
            files[kind].append(str(path))
    titles = {name: name for name in scenes}
    targets = {kind: str(folder / f"prices.{kind}") for kind in PICTURE_ENDINGS}
    price_figure.write_prices(told | {"titles": titles}, files, targets)
    return pd.read_csv(targets["csv"])


def test_the_figure_shows_what_was_solved_and_forecast(cylinder, tmp_path):
    shown = draw({"cylinder": cylinder}, tmp_path, prices_figure_job(PRICES, "quick"))
    assert shown.seconds.notna().all()
    assert (tmp_path / "prices.png").stat().st_size > 10_000


def test_every_scene_has_its_own_numbers_whatever_the_order_of_files_and_titles(cylinder, tmp_path):
    data, spent = cylinder
    slower = data.assign(predicted_units=2 * data.predicted_units), spent
    shown = draw({"slow_cylinder": slower, "cylinder": cylinder}, tmp_path, prices_figure_job(PRICES, "quick"))
    for name, factor in (("cylinder", 1.0), ("slow_cylinder", 2.0)):
        rows = shown[shown.scene == name]
        assert rows.predicted_units.to_numpy() == pytest.approx(factor * data.predicted_units.values)


def test_the_figure_needs_its_file_and_refuses_what_is_not_known(tmp_path):
    plan = Plan.read(ROOT / "config", "standard")
    assert read_prices(tmp_path, plan) is None
    text = (ROOT / "config/price_of_accuracy.yaml").read_text()
    for old, new, key, allowed in (
        ("study: smooth_line", "study: cylinders", "study", "the name of a study"),
        ("limit: 3.0e+7", "limit: 0", "limit", "transforms of 4096 points"),
        ("errors: [0.1, ", "errors: [-0.1, ", "errors", "a list of relative errors"),
        ("errors: [0.1, ", "errors: [5.0, ", "errors", "below 1"),
    ):
        (tmp_path / "price_of_accuracy.yaml").write_text(text.replace(old, new))
        with refused(key, allowed):
            read_prices(tmp_path, plan)
