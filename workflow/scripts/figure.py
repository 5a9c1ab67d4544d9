"""One figure: PNG, PDF, and its numbers as CSV."""

import json

from contactsim.figures.render import render
from contactsim.joblog import logged

logged(snakemake.log[0])
render(json.loads(snakemake.params.plan), snakemake.input.data, snakemake.input.get("costs"), snakemake.output)
