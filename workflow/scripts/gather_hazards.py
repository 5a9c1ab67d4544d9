"""The surveys of all hazards into one dataset."""

import json

from job import open_job

from contactsim import dataset
from contactsim.evaluation.robustness.survey import merge_surveys

seal = open_job(snakemake)
plan = json.loads(snakemake.params.plan)
data = merge_surveys(map(dataset.load_dataset, plan["paths"]))
dataset.write(dataset.stamp(data, plan["settings"]["title"], plan["settings"], plan["source"]), snakemake.output[0])
seal()
