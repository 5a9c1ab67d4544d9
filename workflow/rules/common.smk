# Reads and checks the config once, and keeps two runs in one folder apart.
import fcntl
import sys
from pathlib import Path

from contactsim.errors import SceneError
from contactsim.plan import Plan
from contactsim.provenance import canonical

try:
    if set(config) - {"tier"}:
        raise SceneError("--config", sorted(set(config) - {"tier"}), "tier=NAME")
    PLAN = Plan.read(Path(workflow.basedir) / "config", config.get("tier"))
except SceneError as error:
    sys.exit(f"Error: {error}")
RESULTS = PLAN.results
STABILITY = ["stability"] if PLAN.stability else []

if workflow.is_main_process and not workflow.output_settings.dryrun:
    Path(".snakemake").mkdir(exist_ok=True)
    LOCK = open(".snakemake/one-at-a-time", "w")
    try:
        fcntl.flock(LOCK, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        sys.exit("Error: another snakemake is at work in this folder; wait for it or stop it")


def figure_files(name):
    return [RESULTS / "figures" / f"{name}{ending}" for ending in (".png", ".pdf", ".csv")]


def all_figures(wildcards):
    return [file for name in [*PLAN.figures, *STABILITY] for file in figure_files(name)]


def target_lines():
    lines = [f"  {name:14} {figure.settings['title']}" for name, figure in PLAN.figures.items()]
    lines += [f"  {name:14} dataset: {study.settings['title']}" for name, study in PLAN.studies.items()]
    lines += [f"  {name:14} {PLAN.stability['title']}" for name in STABILITY]
    return "\n".join([*lines, f"  {'all':14} every figure and table"])


def list_targets(wildcards):
    print(f"Targets (tier {PLAN.tier}; another: --config tier=NAME):\n{target_lines()}")
    return Path(workflow.basedir) / "config/config.yaml"


def refuse_target(wildcards):
    sys.exit(f"Error: there is no target {wildcards.name!r}; there are:\n{target_lines()}")
