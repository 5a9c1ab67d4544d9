"""Every solver on one hazard, at every severity."""

import json

from joblog import open_log

from contactsim import dataset
from contactsim.evaluation.robustness.survey import survey_hazard

open_log(snakemake.log[0])
dataset.write(survey_hazard(**json.loads(snakemake.params.plan)), snakemake.output[0])
