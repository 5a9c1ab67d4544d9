"""Coverage factors and relations, fitted, as the package keeps them."""

import pandas as pd
from job import open_job

from contactsim.evaluation.calibration.fit import format_fit
from contactsim.files import write_text

seal = open_job(snakemake)
write_text(format_fit([pd.read_csv(table) for table in snakemake.input.tables]), snakemake.output[0])
seal()
