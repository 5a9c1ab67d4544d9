"""The figure of what leaving effects out changes."""

import json

from contactsim.figures.diagnostics.effect_maps import render
from joblog import open_log

open_log(snakemake.log[0])
render(json.loads(snakemake.params.plan), snakemake.input, snakemake.output)
