"""All trials: one dataset, a figure and a table."""

import json

from contactsim.figures.diagnostics.trials import render
from contactsim.joblog import logged

logged(snakemake.log[0])
render(json.loads(snakemake.params.plan), snakemake.input.data, snakemake.input.costs, snakemake.output)
