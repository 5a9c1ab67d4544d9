"""The results of all baselines, in the tables that the package contains."""

from pathlib import Path

from job import open_job

from contactsim.evaluation.work_precision.baselines import Baseline, write_baselines

seal = open_job(snakemake)
measured = [Baseline.from_files(*files) for files in zip(snakemake.input.data, snakemake.input.costs, strict=True)]
write_baselines(measured, Path(snakemake.output.jobs))
seal()
