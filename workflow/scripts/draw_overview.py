"""All kinds of scene on one page: error against cost."""

import json

from contactsim.figures.diagnostics.overview import render
from joblog import open_log

open_log(snakemake.log[0])
render(json.loads(snakemake.params.plan), snakemake.input, snakemake.output)
