"""The figure of one accuracy case."""

import json

from contactsim.figures.diagnostics.accuracy import render
from contactsim.joblog import logged

logged(snakemake.log[0])
render(json.loads(snakemake.params.plan), snakemake.input, snakemake.output)
