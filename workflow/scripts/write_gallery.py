"""Small pictures, verdicts, errors and costs of all figures, as they stand in the README."""

import json
from pathlib import Path

from job import open_job

from contactsim.publish import gallery
from contactsim.study.plan import Plan

seal = open_job(snakemake)
target = Path(snakemake.output[0])
settings = json.loads(snakemake.params.plan)
plan = Plan.read(snakemake.params.config, settings["tier"])
gallery.write_gallery(plan, target.parent.parent, target.parent, settings["others"])
seal()
