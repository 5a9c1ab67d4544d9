# One job a study, variant and member, sweeping all its loads.
def run_params(wildcards):
    run = PLAN.run(wildcards.study, wildcards.variant, wildcards.member)
    return canonical({"settings": run.settings, "source": run.source, "module": STAGES[run.stage][0]})


def run_label(wildcards):
    run = PLAN.run(wildcards.study, wildcards.variant, wildcards.member)
    places = [f"{name} {value}" for name, value in run.coordinates.items() if name != "points"]
    return " ".join(["", *places, f"on {run.settings['points']} points"])


def run_decision(wildcards):
    return PLAN.decision(PLAN.run(wildcards.study, wildcards.variant, wildcards.member)) or []


def run_twin(wildcards):
    return PLAN.twin(PLAN.run(wildcards.study, wildcards.variant, wildcards.member)) or []


def run_outlook(wildcards):
    run = PLAN.run(wildcards.study, wildcards.variant, wildcards.member)
    return run, RESULTS / f"costs/runs/{run.stem}.json"


def run_memory(wildcards, attempt):
    return resources.memory_asked(*run_outlook(wildcards), attempt)


def run_minutes(wildcards, attempt):
    return resources.minutes_asked(*run_outlook(wildcards), attempt)


def run_group(wildcards):
    name = together("runs")(wildcards)
    return name if name and resources.is_short(*run_outlook(wildcards)) else None


def decide_params(wildcards):
    return canonical(PLAN.decision_settings(wildcards.study, wildcards.variant))


rule decide:
    output:
        decision=RESULTS / "decisions/{study}/{variant}.json",
        costs=RESULTS / "costs/decisions/{study}/{variant}.json",
    log: RESULTS / "logs/decisions/{study}/{variant}.log"
    params: plan=decide_params
    group: together("decisions")
    message: "{wildcards.study} {wildcards.variant}: what is negligible"
    script: "../scripts/decide.py"


rule run:
    input:
        decision=run_decision,
        twin=run_twin,
    output:
        data=update(RESULTS / "runs/{study}/{variant}/{member}.nc"),
        costs=update(RESULTS / "costs/runs/{study}/{variant}/{member}.json"),
        done=RESULTS / "runs/{study}/{variant}/{member}.done",  # written last, so a run that failed is never taken for one that is up to date
    log: RESULTS / "logs/runs/{study}/{variant}/{member}.log"
    params: plan=run_params, label=run_label
    resources: mem_mb=run_memory, runtime=run_minutes   # asked of a cluster; others: profiles/slurm
    group: run_group
    message: "{wildcards.study} {wildcards.variant}: member {wildcards.member}{params.label}"
    script: "../scripts/run.py"
