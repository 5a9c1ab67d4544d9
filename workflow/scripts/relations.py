"""The relations of all kinds, fitted, as the package keeps them."""

import pandas as pd

from contactsim.files import write_text
from contactsim.joblog import logged
from contactsim.regression import as_text

logged(snakemake.log[0])
write_text(as_text(pd.concat(map(pd.read_csv, snakemake.input.tables))), snakemake.output[0])
