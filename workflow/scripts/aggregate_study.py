"""All runs of a study into its dataset and its table of costs."""

import json

from joblog import open_log

from contactsim import dataset
from contactsim.analysis import aggregate, costs
from contactsim.files import write_text

open_log(snakemake.log[0])
plan = json.loads(snakemake.params.plan)
data = aggregate.aggregate(plan["runs"], plan["settings"], plan["source"])
dataset.write(data, snakemake.output.data)
write_text(costs.table(plan["runs"]).to_csv(index=False), snakemake.output.costs)
