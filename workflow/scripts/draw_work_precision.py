"""The figure of one accuracy case."""

import json

from joblog import open_log

from contactsim.figures.diagnostics.accuracy import write_accuracy

open_log(snakemake.log[0])
write_accuracy(json.loads(snakemake.params.plan), snakemake.input, snakemake.output)
