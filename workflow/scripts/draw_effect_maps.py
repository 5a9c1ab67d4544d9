"""The figure of what leaving effects out changes."""

import json

from joblog import open_log

from contactsim.figures.diagnostics.effect_maps import render

open_log(snakemake.log[0])
render(json.loads(snakemake.params.plan), snakemake.input, snakemake.output)
