"""One run: all loads of one member of one variant."""

import json
from importlib import import_module

from job import open_job

from contactsim.files import write_text
from contactsim.study.execute import RunFiles

seal = open_job(snakemake)
plan, files = json.loads(snakemake.params.plan), RunFiles(snakemake.output.data, snakemake.output.costs)
neglect = {name: snakemake.input[name] for name in ("decision", "twin") if snakemake.input.get(name)}
import_module(plan["module"]).run(plan["settings"], plan["source"], files, threads=snakemake.threads, **neglect)
write_text(plan["source"], snakemake.output.done)
seal()
