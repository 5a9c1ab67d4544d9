"""The figure of all candidates for the cell of the probe."""

import json
from pathlib import Path

from joblog import open_log

from contactsim.analysis.admissible import read_candidates
from contactsim.figures.diagnostics.identification import write_identification

open_log(snakemake.log[0])
write_identification(json.loads(snakemake.params.plan), read_candidates(Path(snakemake.input[0])), snakemake.output)
