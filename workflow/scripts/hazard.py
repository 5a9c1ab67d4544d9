"""Every solver on one hazard, at every severity."""

import json

from contactsim import dataset
from contactsim.evaluation.robustness.survey import survey
from contactsim.joblog import logged

logged(snakemake.log[0])
dataset.write(survey(**json.loads(snakemake.params.plan)), snakemake.output[0])
