"""The figure of what effects cost."""

import json

from contactsim.figures.diagnostics.effects import render
from joblog import open_log

open_log(snakemake.log[0])
render(json.loads(snakemake.params.plan), snakemake.input.data, snakemake.input.costs, snakemake.output)
