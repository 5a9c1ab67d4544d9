"""Scenes of one kind, each on a ladder of every knob."""

import json

from contactsim.calibration import measured
from contactsim.files import write_text
from contactsim.joblog import logged

logged(snakemake.log[0])
write_text(measured(json.loads(snakemake.params.plan)).to_csv(index=False), snakemake.output[0])
