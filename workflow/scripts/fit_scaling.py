"""The relations of all kinds, fitted, as the package keeps them."""

import pandas as pd
from job import open_job

from contactsim.evaluation.calibration.fit import format_relations
from contactsim.files import write_text

seal = open_job(snakemake)
write_text(format_relations(pd.concat(map(pd.read_csv, snakemake.input.tables))), snakemake.output[0])
seal()
