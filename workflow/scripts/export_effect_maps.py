"""All maps of what leaving effects out changes, as the package keeps them."""

import json

from job import open_job

from contactsim import dataset
from contactsim.evaluation.effects.map_settings import EffectMap
from contactsim.evaluation.effects.survey import format_maps
from contactsim.files import write_text

seal = open_job(snakemake)
sections = json.loads(snakemake.params.plan)["maps"]
maps = {name: EffectMap.from_settings(section) for name, section in sorted(sections.items())}
changes = dict(zip(maps, map(dataset.load_dataset, snakemake.input.maps), strict=True))
write_text(format_maps(maps, changes), snakemake.output[0])
seal()
