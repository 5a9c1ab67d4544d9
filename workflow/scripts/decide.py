"""What is negligible in a variant of a study; what the check spent apart."""

import json

from contactsim.error_control.neglect import decide
from contactsim.files import write_text
from contactsim.joblog import logged

logged(snakemake.log[0])
plan = json.loads(snakemake.params.plan)
found = decide(plan["settings"], **plan["settings"]["auto"])
write_text(found.text, snakemake.output.decision)
write_text(json.dumps({"seconds": found.seconds}), snakemake.output.costs)
