"""One scene solved to smaller and smaller errors; seconds are kept apart."""

import json

from job import open_job
from threadpoolctl import threadpool_limits

from contactsim import dataset
from contactsim.evaluation.work_precision.prices import measure_price
from contactsim.files import write_text

seal = open_job(snakemake)
job = json.loads(snakemake.params.plan)
with threadpool_limits(1, "blas"):  # snakemake lets a job have as many as it keeps from others
    data, spent = measure_price(job["settings"])
dataset.write(dataset.stamp(data, "price of accuracy", job["settings"], job["source"]), snakemake.output.data)
write_text(json.dumps(spent), snakemake.output.costs)
seal()
