"""The report of a tier on one page."""

import json
from pathlib import Path

from job import open_job

from contactsim.files import write_text
from contactsim.publish import report
from contactsim.study.plan import Plan

seal = open_job(snakemake)
settings, target = json.loads(snakemake.params.plan), Path(snakemake.output[0])
plan = Plan.read(snakemake.params.config, settings["tier"])
write_text(report.page_text(report.collect_results(plan, settings, target.parent)), target)
seal()
