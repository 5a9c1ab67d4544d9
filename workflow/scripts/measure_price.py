"""One scene solved to smaller and smaller errors; seconds are kept apart."""

import json

from job import open_job

from contactsim import dataset
from contactsim.evaluation.work_precision.prices import PriceJob, measure_price
from contactsim.files import write_text
from contactsim.threads import limit_threads

seal = open_job(snakemake)
job = json.loads(snakemake.params.plan)
with limit_threads(1):  # snakemake lets a job have as many as it keeps from others
    data, spent = measure_price(PriceJob.from_settings(job["settings"]))
dataset.write(dataset.stamp(data, "price of accuracy", job["settings"], job["source"]), snakemake.output.data)
write_text(json.dumps(spent), snakemake.output.costs)
seal()
