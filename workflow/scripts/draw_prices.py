"""The figure of what accuracy costs."""

import json

from job import open_job

from contactsim.figures.diagnostics.prices import write_prices

seal = open_job(snakemake)
files = {"data": snakemake.input.data, "costs": snakemake.input.costs}
write_prices(json.loads(snakemake.params.plan), files, snakemake.output)
seal()
