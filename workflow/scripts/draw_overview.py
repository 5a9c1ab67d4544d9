"""All kinds of scene on one page: error against cost."""

import json

from job import open_job

from contactsim.figures.diagnostics.overview import write_overview

seal = open_job(snakemake)
write_overview(json.loads(snakemake.params.plan), snakemake.input, snakemake.output)
seal()
