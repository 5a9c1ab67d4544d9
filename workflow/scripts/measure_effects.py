"""Measure the cost of effects; seconds and memory are kept apart."""

import json

from job import open_job

from contactsim import dataset
from contactsim.evaluation.effects import effect_cost
from contactsim.files import write_text
from contactsim.threads import limit_threads

seal = open_job(snakemake)
job = json.loads(snakemake.params.plan)
with limit_threads(1):  # snakemake lets a job have as many as it keeps from others
    data, spent = effect_cost.measure_effects(effect_cost.CostJob.from_settings(job["settings"]))
dataset.write(dataset.stamp(data, "what effects cost", job["settings"], job["source"]), snakemake.output.data)
write_text(json.dumps(spent), snakemake.output.costs)
seal()
