"""One run: all loads of one member of one variant."""

import json
from pathlib import Path

from contactsim.joblog import logged
from contactsim.march import run

logged(snakemake.log[0])
plan = json.loads(snakemake.params.plan)
run(plan["settings"], plan["source"], snakemake.output.data, snakemake.output.costs, snakemake.threads)
Path(snakemake.output.done).write_text(plan["source"])
