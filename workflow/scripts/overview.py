"""All kinds of scene on one page: error against cost."""

import json

from contactsim.figures.diagnostics.overview import render
from contactsim.joblog import logged

logged(snakemake.log[0])
render(json.loads(snakemake.params.plan), snakemake.input, snakemake.output)
