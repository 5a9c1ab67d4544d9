# Reads and checks the config once, and keeps two runs in one folder apart.
import os
import sys
from pathlib import Path

ROOT = Path(workflow.basedir)
sys.path.insert(0, str(ROOT / "workflow/lib"))

from contactsim.errors import InputError
from contactsim.study.as_typed import as_typed
from baseline_jobs import BaselineJobs
from identification_jobs import CandidateJobs
from jobs import EvaluationJobs, ResultJobs, RunJobs, code_digest, group_on_cluster, timed_threads
from library import share_library
from lock import lock_folder
from pages import Pages
from products import Products
from unsealed import check_all_outputs

CONFIG = ROOT / "config"
share_library()
try:
    PRODUCTS = Products.read(CONFIG, config)
except InputError as error:
    sys.exit(f"Error: {as_typed(error)}")
PLAN, RESULTS = PRODUCTS.plan, PRODUCTS.results
RUN_JOBS, RESULT_JOBS, EVALUATION_JOBS, PAGES = RunJobs(PLAN), ResultJobs(PLAN), EvaluationJobs(PRODUCTS), Pages(PRODUCTS)
CANDIDATE_JOBS, BASELINE_JOBS = CandidateJobs(PRODUCTS), BaselineJobs(PRODUCTS)

config["runs_alike"] = PLAN.runs_alike   # for jobs to look at; none depends on it

if workflow.is_main_process and not workflow.output_settings.dryrun:
    LOCK = lock_folder(Path(".snakemake"))


onstart:
    print(RUN_JOBS.predict(workflow.dag.needrun_jobs(), workflow.cores), file=sys.stderr)
