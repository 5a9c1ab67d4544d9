"""All trials: one dataset, a figure and a table."""

import json

from joblog import open_log

from contactsim.figures.diagnostics.trials import render

open_log(snakemake.log[0])
render(json.loads(snakemake.params.plan), snakemake.input.data, snakemake.input.costs, snakemake.output)
