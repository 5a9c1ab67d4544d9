"""The figure of all candidates for the cell of the probe."""

import json

import pandas as pd
from joblog import open_log

from contactsim.figures.diagnostics.identification import write_identification

open_log(snakemake.log[0])
write_identification(json.loads(snakemake.params.plan), pd.read_csv(snakemake.input[0]), snakemake.output)
