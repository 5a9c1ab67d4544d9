"""Two folders of results are compared number by number, across a change of names."""

from __future__ import annotations

import json
import sys

import numpy as np
import pytest
import xarray as xr
import yaml

from support.places import ROOT

sys.path.insert(0, str(ROOT / "benchmarks"))

import compare_results

TABLE = {
    "variables": {"kappa_bond": "kappa_pairs", "slid": "distance"},
    "values": {"broken": "skipped"},
    "files": {"datasets/ch3_old": "datasets/ch3_new", "runs/old": "runs/new"},
    "texts": ["long_name", "because"],
    "digests": ["source_digest"],
    "times": ["seconds"],
    "added": {"extra": "for the tests"},
}
NAMES = {"kappa_bond": "kappa_pairs", "slid": "distance", "broken": "skipped"}


def translated(name: str, names: dict[str, str]) -> str:
    for old, new in names.items():
        name = name.replace(old, new)
    return name


def run(seed: int, names: dict[str, str]) -> xr.Dataset:
    values = np.random.default_rng(seed).random(3)
    data = xr.Dataset({"kappa_bond": ("slid", values), "kappa_bond_mean": ((), np.nan)}, {"slid": [0.0, 1.0, 2.0]})
    data["kappa_bond"].attrs = {"units": "1", "long_name": str(sorted(names))}
    data["kind"] = ("slid", np.array([names.get("broken", "broken"), "b", ""], object))
    data.attrs = {"source_digest": str(sorted(names))}
    return data.rename({name: translated(str(name), names) for name in data.variables})


def write_results(folder, names):
    """Write results by these names; the digests in paths and the order of rows depend on them."""
    study = translated("old", {"old": "new"} if names else {})
    variants = ["aaaa", "bbbb"] if names else ["cccc", "dddd"]
    for seed, variant in enumerate(variants[::-1] if names else variants):
        place = folder / f"runs/{study}/{variant}"
        place.mkdir(parents=True)
        run(seed, names).to_netcdf(place / "0.nc")
    for part in ("datasets", "figures", "decisions/auto/" + variants[0], "logs"):
        (folder / part).mkdir(parents=True)
    run(7, names).to_netcdf(folder / f"datasets/ch3_{study}.nc")
    rows = [["a", "0.1", "2.5"], ["b", "0.2", "1.5"]]
    header = ["name", translated("kappa_bond", names), "seconds"]
    lines = [",".join(row) for row in [header, *(rows[::-1] if names else rows)]]
    (folder / "figures/fig.csv").write_text("\n".join(lines) + "\n")
    decision = {"kept": [translated("slid", names)], "change": {"x": 0.1, "y": None}}
    (folder / f"decisions/auto/{variants[0]}/0.json").write_text(json.dumps(decision))
    (folder / "logs/run.json").write_text(json.dumps({"time": len(names)}))


@pytest.fixture
def folders(tmp_path):
    for name, names in (("old", {}), ("new", NAMES)):
        write_results(tmp_path / name, names)
    (tmp_path / "table.yaml").write_text(yaml.safe_dump(TABLE))
    return tmp_path


def compared(folder, capsys, *options: str) -> tuple[int, str]:
    code = compare_results.main(
        [str(folder / "old"), str(folder / "new"), "--table", str(folder / "table.yaml"), *options],
    )
    return code, capsys.readouterr().out


def edit(folder, pattern, how):
    path = next(iter(sorted((folder / "new").glob(pattern))))
    data = xr.load_dataset(path)
    how(data).to_netcdf(path)


def test_renamed_results_are_equal_and_what_may_differ_is_listed_with_its_reason(folders, capsys):
    code, text = compared(folders, capsys)
    assert code == 0, text
    assert "0 differ" in text
    assert "may differ: text of long_name" in text
    assert "may differ: digest of source_digest" in text
    assert "may differ: order of rows (1 times)" in text


@pytest.mark.parametrize("place", ["runs/new/*/0.nc", "datasets/ch3_new.nc"])
@pytest.mark.parametrize(
    "how",
    [
        lambda data: data.assign(kappa_pairs=data.kappa_pairs + np.array([0, 0, 1e-16 * 2])),
        lambda data: data.assign(kappa_pairs=data.kappa_pairs.astype(np.float32)),
        lambda data: data.assign(kappa_pairs=data.kappa_pairs.assign_attrs(units="nm")),
        lambda data: data.assign(kappa_pairs_mean=1.0),
        lambda data: data.assign_coords(distance=[0.0, 1.0, 3.0]),
        lambda data: data.drop_vars("kappa_pairs_mean"),
        lambda data: data.assign(another=1.0),
        lambda data: data.assign(kind=("distance", np.array(["skipped", "c", ""], object))),
        lambda data: data.isel(distance=[0, 1]),
    ],
)
def test_a_number_a_unit_or_a_name_that_differs_is_an_error(folders, capsys, place, how):
    edit(folders, place, how)
    code, text = compared(folders, capsys)
    assert code == 1
    assert "DIFFERS: " + place.partition("*")[0] in text


def test_a_name_of_one_tree_alone_is_explained_by_the_table(folders, capsys):
    edit(folders, "datasets/ch3_new.nc", lambda data: data.assign(extra=1.0))
    code, text = compared(folders, capsys)
    assert code == 0, text
    assert "extra new: for the tests" in text


def test_cells_keys_and_files_that_differ_are_errors(folders, capsys):
    path = folders / "new/figures/fig.csv"
    path.write_text(path.read_text().replace("0.2", "0.20000000000000001").replace("2.5", "9"))
    decision = folders / "new/decisions/auto/aaaa/0.json"
    decision.write_text(decision.read_text().replace("null", "1.0"))
    (folders / "new/datasets/ch3_new.nc").unlink()
    (folders / "new/figures/other.csv").write_text("a\n1\n")
    code, text = compared(folders, capsys)
    assert code == 1
    assert "DIFFERS: figures/fig.csv: kappa_pairs: " in text
    assert "DIFFERS: decisions/auto/aaaa/0.json: y: other values" in text
    assert "DIFFERS: datasets/ch3_old.nc: missing" in text
    assert "new file: figures/other.csv" in text


def test_of_a_part_of_the_new_results_what_is_there_is_compared(folders, capsys):
    (folders / "new/datasets/ch3_new.nc").unlink()
    assert compared(folders, capsys)[0] == 1
    assert compared(folders, capsys, "--part")[0] == 0


def test_the_table_of_this_project_can_be_read():
    renaming = compare_results.Renaming.read(compare_results.TABLE)
    assert renaming.name("kappa_r_bond_grid_error") == "kappa_r_pairs_grid_error"
    assert renaming.name("contact_point") == "contact_point"
    assert renaming.reason("seconds") == "time"
