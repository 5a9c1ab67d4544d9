"""The figure of all candidates for the cell of the probe."""

import json
from pathlib import Path

from job import open_job

from contactsim.analysis.admissible import read_candidates
from contactsim.figures.diagnostics.identification import write_identification

seal = open_job(snakemake)
write_identification(json.loads(snakemake.params.plan), read_candidates(Path(snakemake.input[0])), snakemake.output)
seal()
