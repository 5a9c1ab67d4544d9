"""Kill a workflow again and again, with SIGKILL at random moments, and compare its results with an undisturbed one.

    python benchmarks/kills.py FOLDER REFERENCE [COUNT]    # 60 kills by default: half an hour, alone

FOLDER is a clone with its environment and no results, REFERENCE another one in which `make all TIER=quick` was done
without disturbance by the same code. Victims in turn: the main process; a job, and two seconds later all; all processes
of the main one's group. After each kill what still runs half a minute later is counted. At the end the same command
finishes, and all reproducible results are compared byte for byte. The table `kills.csv` beside this file names the jobs
at work at each kill.
"""

from __future__ import annotations

import csv
import hashlib
import os
import random
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

TABLE = Path(__file__).with_suffix(".csv")
COUNT, TIER, PATIENCE, PAUSE = 60, "quick", 30.0, 2.0
START, WINDOW = 6.0, 30.0
"""Seconds after the start until the first moment of a kill, and from there to the last."""
MARK = "CONTACTSIM_KILLS"
REPRODUCIBLE = ("runs/**/*.nc", "datasets/*.nc", "decisions/**/*.json", "figures/fig_*.csv")


def processes(mark: str) -> list[int]:
    """Return the living processes that were started under a mark."""
    found = []
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            alive = (folder / "stat").read_text().rpartition(")")[2].split()[0] not in "ZX"
            if alive and f"{MARK}={mark}".encode() in (folder / "environ").read_bytes().split(b"\0"):
                found.append(int(folder.name))
        except OSError:
            continue
    return found


def start(clone: Path, mark: str, log: Path) -> subprocess.Popen:
    """Begin to make everything."""
    command = [".venv/bin/snakemake", "--cores", "2", "--logger-progress-full", "all", "--config", f"tier={TIER}"]
    with log.open("w") as file:
        return subprocess.Popen(
            command,
            cwd=clone,
            env=os.environ | {MARK: mark},
            stdout=file,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )


def rules_at_work(log: Path) -> list[str]:
    """Return the messages of jobs that have begun and not ended."""
    text = log.read_text()
    begun = dict(re.findall(r"^Job (\d+): (.*)$", text, re.MULTILINE))
    for ended in re.findall(r"^Finished jobid: (\d+)", text, re.MULTILINE):
        begun.pop(ended, None)
    return [re.sub(r"[:,].*", "", message) for message in begun.values()]


def kill(victim: str, main: subprocess.Popen, mark: str, draw: random.Random) -> None:
    """Kill a victim: the main process, a job, or all."""
    if victim == "all":
        os.killpg(main.pid, signal.SIGKILL)
        return
    others = [pid for pid in processes(mark) if pid != main.pid]
    target = main.pid if victim == "main" or not others else draw.choice(others)
    try:
        os.kill(target, signal.SIGKILL)
    except ProcessLookupError:
        return


def digests(clone: Path) -> dict[str, str]:
    """Return the digests of all reproducible results; pictures are none, as times stand in them."""
    folder = clone / "results" / TIER
    found = sorted(path for pattern in REPRODUCIBLE for path in folder.glob(pattern) if not path.name.startswith("."))
    return {str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest() for path in found}


def main() -> int:
    """Kill, finish, compare, write the table."""
    clone, reference = (Path(argument).resolve() for argument in sys.argv[1:3])
    count, draw, log = int(sys.argv[3]) if len(sys.argv) > 3 else COUNT, random.Random(1), Path(clone) / "kills.log"
    rows: list[dict[str, object]] = []
    while len(rows) < count:
        mark, victim = f"{os.getpid()}.{len(rows)}", ("main", "job", "all")[len(rows) % 3]
        running = start(clone, mark, log)
        moment = draw.uniform(START, START + WINDOW)
        try:
            running.wait(moment)
        except subprocess.TimeoutExpired:
            pass
        else:
            print(f"all was made after {len(rows)} kills")
            break
        at_work = rules_at_work(log)
        kill(victim, running, mark, draw)
        if victim == "job":  # the others go on; so does the workflow, until it is killed too
            time.sleep(PAUSE)
            kill("all", running, mark, draw)
        end = time.monotonic() + PATIENCE
        while (left := processes(mark)) and time.monotonic() < end:
            time.sleep(0.1)
        done = len(digests(clone))
        row = {"kill": len(rows) + 1, "victim": victim, "second": round(moment, 1), "at work": "; ".join(at_work)}
        rows.append(row | {"left": len(left), "results": done})
        print(*rows[-1].values(), sep=" | ", flush=True)
    code = start(clone, "last", log).wait()
    one, other = digests(clone), digests(reference)
    different = sorted(name for name in one.keys() | other.keys() if one.get(name) != other.get(name))
    print(f"exit code {code}; {len(one)} results, {len(different)} differ", *different[:10])
    print(f"{len([*clone.glob('results/**/.*.*')])} temporary files of killed jobs are left")
    with TABLE.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)
    return 0 if not code and not different and not any(row["left"] for row in rows) else 1


if __name__ == "__main__":
    sys.exit(main())
