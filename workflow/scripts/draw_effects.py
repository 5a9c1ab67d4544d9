"""The figure of what effects cost."""

import json

from job import open_job

from contactsim.figures.diagnostics.effects import write_effects

seal = open_job(snakemake)
write_effects(json.loads(snakemake.params.plan), snakemake.input.data, snakemake.input.costs, snakemake.output)
seal()
