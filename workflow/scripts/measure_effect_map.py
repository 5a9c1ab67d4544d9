"""One map of what leaving an effect out changes."""

import json

from job import open_job

from contactsim import dataset
from contactsim.evaluation.effects.survey import MapJob, measure_map

seal = open_job(snakemake)
job = json.loads(snakemake.params.plan)
data = measure_map(MapJob.from_settings(job))
data = dataset.stamp(data, "what an effect changes", job["map"], job["source"])
dataset.write(data, snakemake.output[0])
seal()
