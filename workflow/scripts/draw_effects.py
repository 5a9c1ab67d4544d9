"""The figure of what effects cost."""

import json

from joblog import open_log

from contactsim.figures.diagnostics.effects import write_effects

open_log(snakemake.log[0])
write_effects(json.loads(snakemake.params.plan), snakemake.input.data, snakemake.input.costs, snakemake.output)
