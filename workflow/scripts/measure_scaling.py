"""Scenes of one kind, each on a ladder of every knob."""

import json

from joblog import open_log
from threadpoolctl import threadpool_limits

from contactsim.evaluation.calibration.measurement import ScalingJob, measure_scaling
from contactsim.files import write_text

open_log(snakemake.log[0])
with threadpool_limits(1, "blas"):  # snakemake lets a job have as many as it keeps from others
    table = measure_scaling(ScalingJob.from_settings(json.loads(snakemake.params.plan)))
write_text(table.to_csv(index=False), snakemake.output[0])
