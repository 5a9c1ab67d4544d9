"""The claims of a chapter: verdicts as CSV, and as a table in PNG and PDF."""

import json

from job import open_job

from contactsim import dataset
from contactsim.analysis.admissible import read_candidates
from contactsim.analysis.claims import judge_claims
from contactsim.analysis.costs import read_costs, with_costs
from contactsim.figures.diagnostics.claims import write_claims

seal = open_job(snakemake)
plan = json.loads(snakemake.params.plan)
data = dict(zip(sorted(plan["data"]), map(dataset.load_dataset, snakemake.input.data), strict=True))
for study, path in zip(plan["costs"], snakemake.input.get("costs", []), strict=True):
    data[study] = with_costs(data[study], read_costs(path))
candidates = read_candidates(snakemake.input.get("candidates") or None)  # no file is an empty list
write_claims(judge_claims(dict(plan["claims"]), data, candidates), plan["chapter"], data, snakemake.output)
seal()
