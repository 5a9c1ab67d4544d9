"""What effects cost: the ladder measured, and seconds and memory apart."""

import json

from contactsim import dataset, ladder
from contactsim.files import write_text
from contactsim.joblog import logged

logged(snakemake.log[0])
plan = json.loads(snakemake.params.plan)
data, spent = ladder.measure(plan["settings"])
dataset.write(dataset.stamped(data, "what effects cost", plan["settings"], plan["source"]), snakemake.output.data)
write_text(json.dumps(spent), snakemake.output.costs)
