"""The figure of what effects cost."""

import json

from contactsim.figures.diagnostics.effects import render
from contactsim.joblog import logged

logged(snakemake.log[0])
render(json.loads(snakemake.params.plan), snakemake.input.data, snakemake.input.costs, snakemake.output)
