"""One candidate for the cell of the probe: a dataset for each interface."""

import json
from pathlib import Path

from job import open_job

from contactsim import dataset
from contactsim.evaluation.identification.simulation import CandidateJob, simulate_candidate

seal = open_job(snakemake)
data = simulate_candidate(CandidateJob.from_settings(json.loads(snakemake.params.plan)))
for file in snakemake.output:
    dataset.write(data[Path(file).stem], file)
seal()
