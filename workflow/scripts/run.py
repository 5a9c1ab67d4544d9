"""One run: all loads of one member of one variant."""

import json

from contactsim.error_control.neglect import run
from contactsim.files import write_text
from contactsim.joblog import logged

logged(snakemake.log[0])
plan, files = json.loads(snakemake.params.plan), [snakemake.output.data, snakemake.output.costs]
decision, twin = (snakemake.input.get(name) or None for name in ("decision", "twin"))
run(plan["settings"], plan["source"], *files, snakemake.threads, decision, twin)
write_text(plan["source"], snakemake.output.done)
