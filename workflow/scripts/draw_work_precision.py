"""The figure of one accuracy case."""

import json

from job import open_job

from contactsim.figures.diagnostics.accuracy import write_accuracy

seal = open_job(snakemake)
write_accuracy(json.loads(snakemake.params.plan), snakemake.input, snakemake.output)
seal()
