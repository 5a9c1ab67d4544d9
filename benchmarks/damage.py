"""Damage results in 27 ways, give the same command again, and tell what came of each.

    python benchmarks/damage.py FOLDER

FOLDER is a clone in which `make fig_3_1 TIER=quick` was done. The table `damage.csv` beside this file names each kind,
what the workflow did (made again, refused, or nothing to be done), and whether it said so; at the end of each kind all
results are as they were. The exit code is 1 if one is not.
"""

from __future__ import annotations

import csv
import hashlib
import json
import os
import random
import shutil
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

TABLE = Path(__file__).with_suffix(".csv")
TARGET, TIER = "fig_3_1", "quick"
FLIPS = 200


@dataclass(frozen=True)
class Tier:
    """The results of a tier in a clone."""

    clone: Path

    @property
    def folder(self) -> Path:
        """Folder of the tier's results."""
        return self.clone / "results" / TIER

    @property
    def run(self) -> Path:
        """Dataset of one run."""
        return sorted(self.folder.glob("runs/smooth_line/*/0.nc"))[0]

    @property
    def other_run(self) -> Path:
        """Dataset of another run of the same study."""
        return sorted(self.folder.glob("runs/smooth_line/*/0.nc"))[1]

    @property
    def dataset(self) -> Path:
        """Dataset of a study."""
        return self.folder / "datasets/ch3_smooth_line.nc"

    @property
    def table(self) -> Path:
        """Numbers of a figure."""
        return self.folder / "figures/fig_3_1.csv"

    def seal(self, path: Path) -> Path:
        """Seal of a result."""
        return self.folder / "seals" / f"{path.relative_to(self.folder)}.json"

    def digests(self) -> dict[str, str]:
        """Digest of each result that is reproducible: no times, and no pictures, in which times stand."""
        patterns = ("runs/**/*.nc", "datasets/*.nc", "figures/*.csv")
        found = sorted(path for pattern in patterns for path in self.folder.glob(pattern) if path.is_file())
        return {
            str(path.relative_to(self.folder)): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in found
            if "stem" not in path.parts
        }

    def make(self) -> tuple[int, str]:
        """Give the command again; returns its exit code and what it said."""
        command = [".venv/bin/snakemake", "--cores", "2", TARGET, "--config", f"tier={TIER}"]
        done = subprocess.run(command, cwd=self.clone, capture_output=True, text=True, check=False)
        return done.returncode, done.stdout + done.stderr


def flip(path: Path) -> None:
    """Change one bit in the middle; the times stay."""
    times, content = path.stat(), bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)
    os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))


def cut(path: Path) -> None:
    """Keep the first half."""
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])


def empty(path: Path) -> None:
    """Keep nothing."""
    path.write_bytes(b"")


def lengthen(path: Path) -> None:
    """Append a line."""
    with path.open("ab") as file:
        file.write(b"\n")


def overwrite(path: Path, source: Path) -> None:
    """Put another file's content in its place."""
    path.write_bytes(source.read_bytes())


def link(path: Path, target: Path) -> None:
    """Put a link to another file in its place."""
    path.unlink()
    path.symlink_to(target)


def folder_instead(path: Path) -> None:
    """Put an empty folder in its place."""
    path.unlink()
    path.mkdir()


def change_seal(path: Path, key: str, value: object) -> None:
    """Change a value of a seal."""
    content = json.loads(path.read_text(encoding="utf-8"))
    path.write_text(json.dumps(content | {key: value}), encoding="utf-8")


def change_digit(path: Path) -> None:
    """Change the last digit in a table."""
    text = path.read_text(encoding="utf-8")
    place = max(text.rfind(digit) for digit in "123456789")
    path.write_text(f"{text[:place]}{9 - int(text[place])}{text[place + 1 :]}", encoding="utf-8")


def forget(tier: Tier) -> None:
    """Remove what Snakemake remembers."""
    shutil.rmtree(tier.clone / ".snakemake")


def edit_after_loss(tier: Tier) -> None:
    """Make seals say that other code made the run, and remove what Snakemake remembers."""
    for ending in (".nc", ".json", ".done"):
        for seal in tier.folder.glob(f"seals/**/smooth_line/{tier.run.parent.name}/0{ending}.json"):
            change_seal(seal, "made_from", "0000000000000000")
    forget(tier)


KINDS: dict[str, Callable[[Tier], object]] = {
    "a bit of a run is flipped": lambda tier: flip(tier.run),
    "a run is cut": lambda tier: cut(tier.run),
    "a run is empty": lambda tier: empty(tier.run),
    "a run is longer": lambda tier: lengthen(tier.run),
    "a run is gone": lambda tier: tier.run.unlink(),
    "the folder of a run is gone": lambda tier: shutil.rmtree(tier.run.parent),
    "a run is that of another variant": lambda tier: overwrite(tier.run, tier.other_run),
    "a run is a link to another one": lambda tier: link(tier.run, tier.other_run),
    "a run is a folder": lambda tier: folder_instead(tier.run),
    "a run has become newer": lambda tier: os.utime(tier.run),
    "a run is older than its settings": lambda tier: os.utime(tier.run, (0, 0)),
    "the seal of a run is gone": lambda tier: tier.seal(tier.run).unlink(),
    "the seal of a run is empty": lambda tier: empty(tier.seal(tier.run)),
    "the seal of a run names other contents": lambda tier: change_seal(tier.seal(tier.run), "outputs", {}),
    "the seal of a run is that of another": lambda tier: overwrite(tier.seal(tier.run), tier.seal(tier.other_run)),
    "a bit of a dataset is flipped": lambda tier: flip(tier.dataset),
    "a dataset is cut": lambda tier: cut(tier.dataset),
    "a dataset is gone": lambda tier: tier.dataset.unlink(),
    "a dataset is that of another study": lambda tier: overwrite(
        tier.dataset, tier.dataset.with_name("ch3_smooth_surface.nc")
    ),
    "a run and its dataset are damaged": lambda tier: (flip(tier.run), flip(tier.dataset)),
    "a digit in the table of a figure is changed": lambda tier: change_digit(tier.table),
    "the table of a figure is empty": lambda tier: empty(tier.table),
    "a picture is cut": lambda tier: cut(tier.table.with_suffix(".png")),
    "all seals are gone": lambda tier: shutil.rmtree(tier.folder / "seals"),
    "what Snakemake remembers is lost": forget,
    "that is lost, and the code was edited": edit_after_loss,
    "all but the figures is gone": lambda tier: [shutil.rmtree(tier.folder / name) for name in ("runs", "datasets")],
}


def outcome(code: int, text: str) -> str:
    """Return what the workflow did."""
    if "Traceback" in text:
        return "traceback"
    if code:
        return "refused"
    return "nothing to be done" if "Nothing to be done" in text else "made again"


def count_flips(tier: Tier, draw: random.Random) -> int:
    """Flip a random bit of a random sealed result, many times; returns how often `contactsim verify` names it."""
    sealed = sorted(path for path in tier.folder.rglob("*") if path.is_file() and tier.seal(path).exists())
    found = 0
    for path in (draw.choice(sealed) for _ in range(FLIPS)):
        content = path.read_bytes()
        if not content:
            continue
        place = draw.randrange(len(content))
        path.write_bytes(content[:place] + bytes([content[place] ^ (1 << draw.randrange(8))]) + content[place + 1 :])
        command = [".venv/bin/contactsim", "verify", str(tier.folder)]
        done = subprocess.run(command, cwd=tier.clone, capture_output=True, text=True, check=False)
        found += done.returncode == 1 and path.name in done.stdout + done.stderr
        path.write_bytes(content)
    return found


def main() -> int:
    """Damage, make again, compare, write the table."""
    tier = Tier(Path(sys.argv[1]).resolve())
    before, rows = tier.digests(), []
    for kind, damage in KINDS.items():
        damage(tier)
        code, text = tier.make()
        what = outcome(code, text)
        told = any(words in text for words in ("set aside", "It is made again", "Error"))
        if code:  # it says what to do: remove the file
            for path in [path for path in tier.folder.rglob("*") if str(path) in text or f"{path.name}:" in text]:
                shutil.rmtree(path) if path.is_dir() and not path.is_symlink() else path.unlink(missing_ok=True)
            tier.make()
        for path in tier.folder.rglob("*.aside"):
            shutil.rmtree(path) if path.is_dir() and not path.is_symlink() else path.unlink()
        same = tier.digests() == before
        rows.append({"kind": kind, "outcome": what, "told": told, "as it was": same})
        print(f"{kind:45} {what:20} {'told' if told else '':6} {'' if same else 'DIFFERS'}", flush=True)
    found = count_flips(tier, random.Random(1))
    print(f"{found} of {FLIPS} random flips found by contactsim verify")
    with TABLE.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)
    return 0 if all(row["as it was"] for row in rows) and found == FLIPS else 1


if __name__ == "__main__":
    sys.exit(main())
