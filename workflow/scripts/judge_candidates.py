"""All statements on the probe in all candidates, as one table."""

import json

from job import open_job

from contactsim.evaluation.identification.judgement import judge_files, table_text
from contactsim.files import write_text

seal = open_job(snakemake)
plan = json.loads(snakemake.params.plan)
write_text(table_text(judge_files(plan, snakemake.input), len(plan["candidates"])), snakemake.output[0])
seal()
