"""All results in one folder to deposit."""

import json
from pathlib import Path

from joblog import open_log

from contactsim.publish import bundle

open_log(snakemake.log[0])
plan = json.loads(snakemake.params.plan)
bundle.write_bundle(plan, dict(zip(plan["files"], snakemake.input, strict=True)), Path(snakemake.output[0]).parent)
