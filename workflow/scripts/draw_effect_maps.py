"""The figure of what leaving effects out changes."""

import json

from job import open_job

from contactsim.figures.diagnostics.effect_maps import write_effect_maps

seal = open_job(snakemake)
write_effect_maps(json.loads(snakemake.params.plan), snakemake.input, snakemake.output)
seal()
