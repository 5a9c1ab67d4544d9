# Reads and checks the config once, and keeps two runs in one folder apart.
import fcntl
import functools
import os
import shlex
import sys
from pathlib import Path

from contactsim import standby
from contactsim.evaluation import resources
from contactsim.evaluation.calibration import measurement, sampling, validation
from contactsim.evaluation.effects import effect_cost
from contactsim.evaluation.effects import survey as effect_survey
from contactsim.evaluation.robustness import survey
from contactsim.evaluation.work_precision import case_config, cases
from contactsim.publish import gallery, report
from contactsim.errors import SceneError
from contactsim.study.plan import Plan
from contactsim.study.stages import STAGES
from contactsim.provenance import canonical, digest, source_digest

try:
    if set(config) - {"tier"}:
        raise SceneError("--config", sorted(set(config) - {"tier"}), "tier=NAME")
    CONFIG = Path(workflow.basedir) / "config"
    PLAN = Plan.read(CONFIG, config.get("tier"))
    CASES = case_config.read_cases(CONFIG, PLAN)
    HAZARDS = survey.read_stability(CONFIG, PLAN)
    LADDER = effect_cost.read_ladder(CONFIG, PLAN.seed, PLAN.overrides["effects"], PLAN.tier)
    DRAWS = sampling.read_draws(CONFIG, PLAN.overrides["trials"], PLAN.tier)
    OVERVIEW = case_config.read_overview(CONFIG) if CASES else None
    MAPS = effect_survey.read_maps(CONFIG, PLAN.overrides["effect_maps"], PLAN.tier)
except SceneError as error:
    sys.exit(f"Error: {error}")
RESULTS = PLAN.results
REAL_PYTHON = sys.executable
sys.executable = shlex.quote(sys.executable)  # snakemake starts jobs with it and does not quote it
STABILITY = ["stability"] if HAZARDS else []
EFFECTS = ["effects"] if LADDER else []
TRIALS = ["trials"] if DRAWS else []
OVERVIEWS = ["overview"] if OVERVIEW else []
EFFECT_MAPS = ["effect_maps"] if MAPS else []

if workflow.is_main_process and not workflow.output_settings.dryrun:
    Path(".snakemake").mkdir(exist_ok=True)
    LOCK = open(".snakemake/one-at-a-time", "w")
    try:
        fcntl.flock(LOCK, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        sys.exit("Error: another snakemake is at work in this folder; wait for it or stop it")


onstart:
    _jobs = list(workflow.dag.needrun_jobs())
    _runs = [(PLAN.run(*map(str, job.wildcards)), job.output.costs) for job in _jobs if job.rule.name == "run"]
    _runs = [(run, costs) for run, costs in _runs if PLAN.twin(run) is None]
    _rules = [job.rule.name for job in _jobs if job.rule.name != "run" and job.rule.output]
    print(resources.told(_runs, _rules, workflow.cores), file=sys.stderr)
    workflow.scheduler.job_rate_limiter = None  # else each job adds a timer that wakes the scheduler every second, for good
    if workflow.local_exec and sys.platform == "linux":  # elsewhere forks are not safe
        stand_by()


def stand_by():
    """Have a process stand by of which jobs are forks."""
    place, scripts = f".snakemake/standby-{os.getpid()}", str(Path(workflow.basedir) / "workflow/scripts")
    workflow.standing_by, command = standby.start(REAL_PYTHON, place, scripts)
    sys.executable = shlex.join(command)


def timed_threads(at_once=1):
    """Cores that a timed job, which computes on one, keeps from others: all, or a share where some may run at once."""
    return -(-workflow.cores // at_once) if PLAN.timed_alone else 1


def together(name):
    """A group of jobs that share a job of a cluster; none in local and dry runs."""
    def group(wildcards):
        if not workflow.non_local_exec:
            return None
        if not workflow.is_main_process:  # there they start together, not each by itself; Snakemake does not pass it on
            workflow.group_settings.group_components = {name: sys.maxsize}
        return name
    return group


def of_the_standard_tier(wildcards):
    if PLAN.overrides["trials"] or PLAN.overrides["effect_maps"]:
        sys.exit(f"Error: tier: got {PLAN.tier}; allowed: one at which trials and maps are whole, such as standard")
    return []


def figure_files(name):
    kinds = PLAN.figures[name].endings if name in PLAN.figures else ("png", "pdf", "csv")
    return [RESULTS / "figures" / f"{name}.{kind}" for kind in kinds]


def all_figures(wildcards):
    names = [*PLAN.figures, *STABILITY, *EFFECTS, *TRIALS, *EFFECT_MAPS, *OVERVIEWS, *(f"accuracy_{case}" for case in CASES)]
    return [file for name in names for file in figure_files(name)]


def all_claims(wildcards):
    return [RESULTS / "claims" / f"{chapter}{ending}" for chapter in PLAN.claims for ending in (".csv", ".png", ".pdf")]


def target_lines():
    lines = [f"  {name:14} {figure.settings['title']}" for name, figure in PLAN.figures.items()]
    lines += [f"  {name:14} dataset: {study.settings['title']}" for name, study in PLAN.studies.items()]
    lines += [f"  {name:14} {HAZARDS['title']}" for name in STABILITY]
    lines += [f"  {name:14} {LADDER['title']}" for name in EFFECTS]
    lines += [f"  {name:14} {DRAWS['title']}" for name in TRIALS]
    lines += [f"  {name:14} {OVERVIEW['title']}" for name in OVERVIEWS]
    lines += [f"  {name:14} {MAPS['title']}" for name in EFFECT_MAPS]
    lines += [f"  {f'accuracy_{name}':14} {case.settings['title']}" for name, case in CASES.items()]
    lines += [f"  {'accuracy':14} all of those that begin so"] * bool(CASES)
    lines += [f"  {'claims':14} what the thesis states, and whether it is reproduced"] * bool(PLAN.claims)
    lines += [f"  {'report':14} all that was found, on one page"]
    lines += [f"  {'all':14} all of these, beside which there are:"]
    lines += [f"  {'gallery':14} the figures in small pictures, with verdicts, errors and costs"]
    return "\n".join([*lines, f"  {'bundle':14} all results in one folder to deposit"])


def list_targets(wildcards):
    print(f"Targets (tier {PLAN.tier}; another: make TARGET TIER=NAME, or --config tier=NAME):\n{target_lines()}")
    return CONFIG / "config.yaml"


def refuse_target(wildcards):
    sys.exit(f"Error: there is no target {wildcards.name!r}; there are:\n{target_lines()}")
