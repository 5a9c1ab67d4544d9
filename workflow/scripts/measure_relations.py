"""Scenes of one kind, each on a ladder of every knob."""

import json

from contactsim.calibration import measured
from contactsim.joblog import logged
from contactsim.march import write_text

logged(snakemake.log[0])
write_text(measured(json.loads(snakemake.params.plan)).to_csv(index=False), snakemake.output[0])
