"""The figure of what leaving effects out changes."""

import json

from joblog import open_log

from contactsim.figures.diagnostics.effect_maps import write_effect_maps

open_log(snakemake.log[0])
write_effect_maps(json.loads(snakemake.params.plan), snakemake.input, snakemake.output)
