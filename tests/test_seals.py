"""Seals of results: every flipped byte, and every file that is not the one that was made, is found."""

from __future__ import annotations

import json
import shutil
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np
import pytest

from contactsim import seals
from contactsim.cli import main
from contactsim.errors import InputError
from contactsim.seals import Seal, check_inputs, content_digest, seal_path, verify


@pytest.fixture
def results(tmp_path: Path) -> Path:
    """A run, a dataset made of it, and a figure made of that, each with its seal."""
    folder = tmp_path / "standard"
    rng = np.random.default_rng(0)
    for place, before in (("runs/a/0.nc", None), ("datasets/a.nc", "runs/a/0.nc"), ("figures/f.csv", "datasets/a.nc")):
        path = folder / place
        path.parent.mkdir(parents=True)
        path.write_bytes(rng.bytes(5000))
        inputs = {} if before is None else {before: content_digest(folder / before)}
        Seal("rule", {"study": "a"}, "0" * 16, inputs, {place: content_digest(path)}).write(folder)
    return folder


def test_intact_results_are_verified(results: Path, capsys: pytest.CaptureFixture) -> None:
    assert verify(results)[1] == {}
    main(["verify", str(results)])
    assert "3 results with seals, none not as they should be" in capsys.readouterr().out


def test_every_flipped_byte_is_found(results: Path) -> None:
    rng = np.random.default_rng(1)
    places = ["runs/a/0.nc", "datasets/a.nc", "figures/f.csv"]
    for _ in range(200):
        place = places[rng.integers(3)]
        content = bytearray((results / place).read_bytes())
        where, bit = rng.integers(len(content)), 1 << rng.integers(8)
        content[where] ^= bit
        (results / place).write_bytes(content)
        assert verify(results)[1] == {place: "was changed since it was made"}
        content[where] ^= bit
        (results / place).write_bytes(content)
    assert verify(results)[1] == {}


@pytest.mark.parametrize("text", ["[]", "{}", "1", "null", '"x"', "{", '{"rule": 1}'])
def test_what_is_no_seal_is_told(results: Path, text: str) -> None:
    seal_path(results, "datasets/a.nc").write_text(text)
    assert verify(results)[1]["datasets/a.nc"] == "has a seal that cannot be read"


@pytest.mark.parametrize("place", ["../other.txt", "a/../../other.txt", "/etc/hosts"])
def test_a_seal_that_names_a_file_elsewhere_is_none(results: Path, place: str) -> None:
    path = seal_path(results, "datasets/a.nc")
    seal = Seal.read(path)
    for part in ({"inputs": {place: "0"}}, {"outputs": {place: "0"}}):
        path.write_text(json.dumps(asdict(replace(seal, **part))))
        with pytest.raises(InputError, match="a seal of results"):
            Seal.read(path)


def damage(results: Path, kind: str) -> None:
    """Do to the dataset, or to what it was made from, what may happen to files."""
    dataset, seal = results / "datasets/a.nc", seal_path(results, "datasets/a.nc")
    if kind == "emptied":
        dataset.write_bytes(b"")
    elif kind == "shortened":
        dataset.write_bytes(dataset.read_bytes()[:-1])
    elif kind == "gone":
        dataset.unlink()
    elif kind == "a folder":
        dataset.unlink()
        dataset.mkdir()
    elif kind == "another result":
        shutil.copy(results / "runs/a/0.nc", dataset)
    elif kind == "without a seal":
        seal.unlink()
    elif kind == "a new run":
        run = results / "runs/a/0.nc"
        run.write_bytes(b"made again")
        Seal("rule", {"study": "a"}, "1" * 16, {}, {"runs/a/0.nc": content_digest(run)}).write(results)
    elif kind == "run gone with its seal":
        (results / "runs/a/0.nc").unlink()
        seal_path(results, "runs/a/0.nc").unlink()


@pytest.mark.parametrize(
    ("kind", "reason"),
    [
        ("emptied", "was changed since it was made"),
        ("shortened", "was changed since it was made"),
        ("gone", "is gone"),
        ("a folder", "was changed since it was made"),
        ("another result", "was changed since it was made"),
        ("without a seal", "has no seal"),
        ("a new run", "was made from another runs/a/0.nc"),
        ("run gone with its seal", "was made from another runs/a/0.nc"),
    ],
)
def test_each_kind_of_damage_is_told(results: Path, kind: str, reason: str, capsys: pytest.CaptureFixture[str]) -> None:
    damage(results, kind)
    assert verify(results)[1]["datasets/a.nc"] == reason
    with pytest.raises(SystemExit):
        main(["verify", str(results)])
    assert f"{results / 'datasets/a.nc'} {reason}" in capsys.readouterr().out


@pytest.mark.parametrize("kind", ["emptied", "a folder", "another result", "without a seal"])
def test_a_job_refuses_a_result_that_is_not_the_one_that_was_made(results: Path, kind: str) -> None:
    dataset = results / "datasets/a.nc"
    assert check_inputs(results, [dataset, Path("config.yaml")]) == {"datasets/a.nc": content_digest(dataset)}
    damage(results, kind)
    with pytest.raises(InputError, match=r"datasets/a.nc'; allowed: .*remove it, and it is made again"):
        check_inputs(results, [dataset])


def test_what_is_no_seal_is_refused(results: Path, tmp_path: Path) -> None:
    for text in ("", "{", "[1]", '{"rule": 1}'):
        seal_path(results, "datasets/a.nc").write_text(text)
        with pytest.raises(InputError, match="a seal of results"):
            Seal.read(seal_path(results, "datasets/a.nc"))
    assert verify(results)[1]["datasets/a.nc"] == "has a seal that cannot be read"
    with pytest.raises(SystemExit, match=r"folder: got .*; allowed: that of a tier's results"):
        main(["verify", str(tmp_path)])


def test_files_that_need_no_seal_are_left_out(results: Path) -> None:
    for place in ("logs/a.log", "gallery/f.png", f"datasets/a.nc{seals.ASIDE}"):
        (results / place).parent.mkdir(exist_ok=True)
        (results / place).write_text("any")
    assert verify(results)[1] == {}
    seal = Seal.read(seal_path(results, "figures/f.csv"))
    replace(seal, outputs={}).write(results)  # a job without results has no seal
    assert verify(results)[1] == {}
