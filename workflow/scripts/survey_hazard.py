"""Every solver on one hazard, at every severity."""

import json

from job import open_job

from contactsim import dataset
from contactsim.evaluation.robustness.survey import survey_hazard

seal = open_job(snakemake)
dataset.write(survey_hazard(**json.loads(snakemake.params.plan)), snakemake.output[0])
seal()
