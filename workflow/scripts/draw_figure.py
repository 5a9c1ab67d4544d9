"""One figure: PNG, PDF, and its numbers as CSV."""

import json

import pandas as pd
from job import open_job

from contactsim import dataset
from contactsim.figures.layout import write_figure
from contactsim.study.law_table import tabulate_law

seal = open_job(snakemake)
plan, files = json.loads(snakemake.params.plan), snakemake.input
law = plan["settings"]["law"]
data = [dataset.load_dataset(path) for path in files.data] if law is None else [tabulate_law(law)]
write_figure(plan, data, [pd.read_csv(path) for path in files.get("costs", [])], snakemake.output)
seal()
