"""All kinds of scene on one page: error against cost."""

import json

from joblog import open_log

from contactsim.figures.diagnostics.overview import render

open_log(snakemake.log[0])
render(json.loads(snakemake.params.plan), snakemake.input, snakemake.output)
