"""All runs of a study into its dataset and its table of costs."""

import json

from job import open_job

from contactsim import dataset
from contactsim.analysis import aggregate, costs
from contactsim.files import write_text

seal = open_job(snakemake)
plan = json.loads(snakemake.params.plan)
data = aggregate.aggregate(plan["runs"], plan["settings"], plan["source"])
dataset.write(data, snakemake.output.data)
write_text(costs.table(plan["runs"]).to_csv(index=False), snakemake.output.costs)
seal()
