# One job a study, variant and member, sweeping all its loads.
def run_params(wildcards):
    run = PLAN.run(wildcards.study, wildcards.variant, wildcards.member)
    return canonical({"settings": run.settings, "source": run.source})


def run_label(wildcards):
    run = PLAN.run(wildcards.study, wildcards.variant, wildcards.member)
    places = [f"{name} {value}" for name, value in run.coordinates.items() if name != "points"]
    return " ".join(["", *places, f"on {run.settings['points']} points"])


rule run:
    output:
        data=update(RESULTS / "runs/{study}/{variant}/{member}.nc"),
        costs=update(RESULTS / "costs/runs/{study}/{variant}/{member}.json"),
        done=RESULTS / "runs/{study}/{variant}/{member}.done",  # written last, so a run that failed is never taken for one that is up to date
    log: RESULTS / "logs/runs/{study}/{variant}/{member}.log"
    params: plan=run_params, label=run_label
    message: "{wildcards.study} {wildcards.variant}: member {wildcards.member}{params.label}"
    script: "../scripts/run.py"
