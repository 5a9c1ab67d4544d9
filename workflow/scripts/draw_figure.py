"""One figure: PNG, PDF, and its numbers as CSV."""

import json

from joblog import open_log

from contactsim.figures.layout import render

open_log(snakemake.log[0])
files = snakemake.input
render(json.loads(snakemake.params.plan), files.data, files.get("costs", []), snakemake.output)
