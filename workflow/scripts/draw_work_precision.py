"""The figure of one accuracy case."""

import json

from joblog import open_log

from contactsim.figures.diagnostics.accuracy import render

open_log(snakemake.log[0])
render(json.loads(snakemake.params.plan), snakemake.input, snakemake.output)
