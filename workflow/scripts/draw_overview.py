"""All kinds of scene on one page: error against cost."""

import json

from joblog import open_log

from contactsim.figures.diagnostics.overview import write_overview

open_log(snakemake.log[0])
write_overview(json.loads(snakemake.params.plan), snakemake.input, snakemake.output)
