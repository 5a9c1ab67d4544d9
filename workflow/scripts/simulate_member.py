"""One run: all loads of one member of one variant."""

import json
from importlib import import_module

from job import is_sound, open_job, results_of

from contactsim.files import write_text
from contactsim.study.execute import RunFiles

seal = open_job(snakemake)
plan, results = json.loads(snakemake.params.plan), results_of(snakemake)
others = snakemake.config["runs_alike"].get("{study}/{variant}/{member}".format(**snakemake.wildcards), [])
pairs = [(results / f"runs/{stem}.nc", results / f"costs/runs/{stem}.json") for stem in others]
alike = tuple(RunFiles(*pair) for pair in pairs if is_sound(results, pair))
files = RunFiles(snakemake.output.data, snakemake.output.costs, alike)
neglect = {name: snakemake.input[name] for name in ("decision", "twin") if snakemake.input.get(name)}
import_module(plan["module"]).run(plan["settings"], plan["source"], files, threads=snakemake.threads, **neglect)
write_text(plan["source"], snakemake.output.done)
seal()
