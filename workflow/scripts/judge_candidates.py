"""All statements on the probe in all candidates, as one table."""

import json

from joblog import open_log

from contactsim.evaluation.identification.judgement import judge_files
from contactsim.files import write_text

open_log(snakemake.log[0])
table = judge_files(json.loads(snakemake.params.plan), snakemake.input)
write_text(table.to_csv(index=False), snakemake.output[0])
