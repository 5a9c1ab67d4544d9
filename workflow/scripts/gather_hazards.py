"""The surveys of all hazards into one dataset."""

import json

from joblog import open_log

from contactsim import dataset
from contactsim.evaluation.robustness.survey import gather

open_log(snakemake.log[0])
plan = json.loads(snakemake.params.plan)
data = gather(map(dataset.load_dataset, plan["paths"]), plan["settings"], plan["source"])
dataset.write(data, snakemake.output[0])
