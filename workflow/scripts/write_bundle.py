"""All results in one folder to deposit."""

import json
from pathlib import Path

from job import open_job, results_of

from contactsim.publish import bundle, job_list

seal = open_job(snakemake)
plan, target = json.loads(snakemake.params.plan), Path(snakemake.output[0]).parent
jobs = job_list.list_jobs(results_of(snakemake), plan["files"])
bundle.write_bundle(plan, dict(zip(plan["files"], snakemake.input, strict=True)), jobs, target)
seal()
