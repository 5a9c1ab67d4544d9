"""All trials: one dataset, a figure and a table."""

import json

from joblog import open_log

from contactsim.figures.diagnostics.trials import write_trials

open_log(snakemake.log[0])
write_trials(json.loads(snakemake.params.plan), snakemake.input.data, snakemake.input.costs, snakemake.output)
