"""One run: all loads of one member of one variant."""

import json
from pathlib import Path

from contactsim import confirm, march, negligible
from contactsim.joblog import logged

logged(snakemake.log[0])
plan, files = json.loads(snakemake.params.plan), (snakemake.output.data, snakemake.output.costs)
asked, given = plan["settings"], (plan["settings"], plan["source"], files, snakemake.threads)
if "auto" in asked:
    negligible.run(*given, snakemake.input.decision, snakemake.input.get("twin", ()))
else:
    (confirm if "accuracy" in asked else march).run(*given)
Path(snakemake.output.done).write_text(plan["source"])
