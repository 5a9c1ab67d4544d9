"""One scene solved to an accuracy and judged; what was predicted and spent apart."""

import json

from contactsim import dataset, trials
from contactsim.files import write_text
from contactsim.joblog import logged

logged(snakemake.log[0])
plan = json.loads(snakemake.params.plan)
data, spent = trials.trial(plan["settings"], plan["kind"], plan["count"])
dataset.write(dataset.stamped(data, "accuracy on trial", plan["settings"], plan["source"]), snakemake.output.data)
write_text(json.dumps(spent), snakemake.output.costs)
