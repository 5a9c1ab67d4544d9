"""One scene solved to an accuracy and judged; what was predicted and spent apart."""

import json

from job import open_job

from contactsim import dataset
from contactsim.evaluation.calibration.trial import Trial, run_trial
from contactsim.files import write_text
from contactsim.threads import limit_threads

seal = open_job(snakemake)
job = json.loads(snakemake.params.plan)
with limit_threads(1):  # snakemake lets a job have as many as it keeps from others
    data, spent = run_trial(Trial(**job["settings"]))
dataset.write(dataset.stamp(data, "accuracy on trial", job["settings"], job["source"]), snakemake.output.data)
write_text(json.dumps(spent), snakemake.output.costs)
seal()
