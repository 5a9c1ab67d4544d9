"""The page of all that was found; the graph of rules is asked of snakemake while all else is read."""

import json
from pathlib import Path

from joblog import open_log

from contactsim.files import write_text
from contactsim.publish import report, rulegraph
from contactsim.study.plan import Plan

open_log(snakemake.log[0])
settings, target = json.loads(snakemake.params.plan), Path(snakemake.output[0])
asked = rulegraph.ask(settings["tier"])
found = report.found(Plan.read(snakemake.params.config, settings["tier"]), settings, target.parent)
page = report.render(found, rulegraph.answer(asked))
write_text(page, target)
