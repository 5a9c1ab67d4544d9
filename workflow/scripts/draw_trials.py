"""All trials: one dataset, a figure and a table."""

import json

from contactsim.figures.diagnostics.trials import render
from joblog import open_log

open_log(snakemake.log[0])
render(json.loads(snakemake.params.plan), snakemake.input.data, snakemake.input.costs, snakemake.output)
