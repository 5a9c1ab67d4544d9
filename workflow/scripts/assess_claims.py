"""The claims of a chapter: verdicts as CSV, and as a table in PNG and PDF."""

import json

from joblog import open_log

from contactsim.figures.diagnostics.claims import render_claims

open_log(snakemake.log[0])
plan = json.loads(snakemake.params.plan)
render_claims(plan, dict(zip(sorted(plan["data"]), snakemake.input, strict=True)), snakemake.output)
