"""One map of what leaving an effect out changes."""

import json

from joblog import open_log

from contactsim import dataset
from contactsim.evaluation.effects.survey import measure

open_log(snakemake.log[0])
plan = json.loads(snakemake.params.plan)
data = dataset.stamped(measure(plan["name"], plan["map"]), "what an effect changes", plan["map"], plan["source"])
dataset.write(data, snakemake.output[0])
