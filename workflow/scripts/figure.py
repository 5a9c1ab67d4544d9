"""One figure: PNG, PDF, and its numbers as CSV."""

import json

from contactsim.figures.layout import render
from contactsim.joblog import logged

logged(snakemake.log[0])
files = snakemake.input
render(json.loads(snakemake.params.plan), files.data, files.get("costs", []), snakemake.output)
