"""The figure of what leaving effects out changes."""

import json

from contactsim.figures.diagnostics.effect_maps import render
from contactsim.joblog import logged

logged(snakemake.log[0])
render(json.loads(snakemake.params.plan), snakemake.input, snakemake.output)
