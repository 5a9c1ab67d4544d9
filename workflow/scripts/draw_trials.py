"""All trials: one dataset, a figure and a table."""

import json

from job import open_job, seal_job

from contactsim.figures.diagnostics.trials import write_trials

open_job(snakemake)
write_trials(json.loads(snakemake.params.plan), snakemake.input.data, snakemake.input.costs, snakemake.output)
seal_job(snakemake)
