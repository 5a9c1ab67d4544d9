"""One scene for the fit, on several grids and increments."""

import json

from job import open_job

from contactsim.evaluation.calibration.fit import measure_scene
from contactsim.evaluation.calibration.trial import Trial
from contactsim.files import write_text
from contactsim.threads import limit_threads

seal = open_job(snakemake)
with limit_threads(1):  # snakemake lets a job have as many as it keeps from others
    table = measure_scene(Trial(**json.loads(snakemake.params.plan)["settings"]))
write_text(table.to_csv(index=False), snakemake.output[0])
seal()
