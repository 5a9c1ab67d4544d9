"""The page of all that was found; the graph of rules is asked of snakemake."""

import json
import subprocess
import sys
from pathlib import Path

from contactsim import report
from contactsim.figures.render import move
from contactsim.joblog import logged
from contactsim.plan import Plan

logged(snakemake.log[0])
settings, target = json.loads(snakemake.params.plan), Path(snakemake.output[0])
plan = Plan.read(snakemake.params.config, settings["tier"])
ask = [sys.executable, "-m", "snakemake", "--dry-run", "--rulegraph", "dot", "all", "--config", f"tier={plan.tier}"]
rules = subprocess.run(ask, capture_output=True, text=True, check=True).stdout
page = report.render(plan, settings, target.parent, rules)
move(str(target), lambda path: path.write_text(page, encoding="utf-8"))
