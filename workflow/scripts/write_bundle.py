"""All results in one folder to deposit."""

import json
from pathlib import Path

from job import open_job

from contactsim.publish import bundle

seal = open_job(snakemake)
plan = json.loads(snakemake.params.plan)
bundle.write_bundle(plan, dict(zip(plan["files"], snakemake.input, strict=True)), Path(snakemake.output[0]).parent)
seal()
