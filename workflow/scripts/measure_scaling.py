"""Scenes of one kind, each on a ladder of every knob."""

import json

from job import open_job

from contactsim.evaluation.calibration.measurement import ScalingJob, measure_scaling
from contactsim.files import write_text
from contactsim.threads import limit_threads

seal = open_job(snakemake)
with limit_threads(1):  # snakemake lets a job have as many as it keeps from others
    table = measure_scaling(ScalingJob.from_settings(json.loads(snakemake.params.plan)))
write_text(table.to_csv(index=False), snakemake.output[0])
seal()
