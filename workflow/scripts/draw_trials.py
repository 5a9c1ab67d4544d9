"""All trials: one dataset, a figure and a table."""

import json

from job import open_job

from contactsim.figures.diagnostics.trials import write_trials

seal = open_job(snakemake)
write_trials(json.loads(snakemake.params.plan), snakemake.input.data, snakemake.input.costs, snakemake.output)
seal()
