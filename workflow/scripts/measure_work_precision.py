"""One solver of one accuracy case: errors and transforms of every setting, and seconds apart."""

import json

from job import open_job

from contactsim import dataset
from contactsim.error_control.forecast import transform_seconds
from contactsim.evaluation.work_precision.case_config import read_case
from contactsim.files import write_text
from contactsim.threads import limit_threads

seal = open_job(snakemake)
plan, config = json.loads(snakemake.params.plan), snakemake.params.config
case = read_case(config, snakemake.params.tier, snakemake.wildcards.case)
with limit_threads(1):  # snakemake lets a job have as many as it keeps from others
    data, seconds = case.measure(snakemake.wildcards.job)
dataset.write(dataset.stamp(data, f"accuracy of {case.name}", plan["job"], plan["source"]), snakemake.output.data)
write_text(json.dumps({"seconds": seconds, "transform_seconds": transform_seconds()}), snakemake.output.costs)
seal()
