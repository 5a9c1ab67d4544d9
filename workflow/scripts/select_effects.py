"""The effects that a variant of a study neglects; the seconds of the check stand apart."""

import json

from job import open_job

from contactsim.files import write_text
from contactsim.study.select_effects import select_effects

seal = open_job(snakemake)
decision = select_effects(json.loads(snakemake.params.plan)["settings"])
write_text(decision.text, snakemake.output.decision)
write_text(json.dumps({"seconds": decision.seconds}), snakemake.output.costs)
seal()
