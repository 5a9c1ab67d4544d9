"""All maps of what leaving effects out changes, as the package keeps them."""

import json

from joblog import open_log

from contactsim import dataset
from contactsim.evaluation.effects.survey import format_maps
from contactsim.files import write_text

open_log(snakemake.log[0])
settings = json.loads(snakemake.params.plan)
maps = dict(zip(sorted(settings["maps"]), map(dataset.load_dataset, snakemake.input.maps), strict=True))
write_text(format_maps(maps, settings), snakemake.output[0])
