"""The relations of all kinds, fitted, as the package keeps them."""

import pandas as pd
from joblog import open_log

from contactsim.evaluation.calibration.fit import format_relations
from contactsim.files import write_text

open_log(snakemake.log[0])
write_text(format_relations(pd.concat(map(pd.read_csv, snakemake.input.tables))), snakemake.output[0])
