# One job for each study, variant and member, over its whole load path; and the effects that a variant can neglect.
rule select_effects:
    output:
        decision=RESULTS / "decisions/{study}/{variant}.json",
        costs=RESULTS / "costs/decisions/{study}/{variant}.json",
    log: RESULTS / "logs/decisions/{study}/{variant}.log"
    params: plan=RUN_JOBS.selection_params
    group: group_on_cluster(workflow, "decisions")
    message: "{wildcards.study} {wildcards.variant}: effects that can be neglected"
    script: "../scripts/select_effects.py"


rule simulate_member:
    input:
        decision=RUN_JOBS.decision,
        twin=RUN_JOBS.twin,
    output:
        data=update(RESULTS / "runs/{study}/{variant}/{member}.nc"),
        costs=update(RESULTS / "costs/runs/{study}/{variant}/{member}.json"),
        done=RESULTS / "runs/{study}/{variant}/{member}.done",  # written last, so a failed run is never taken for one that is up to date
    log: RESULTS / "logs/runs/{study}/{variant}/{member}.log"
    params: plan=RUN_JOBS.params, label=RUN_JOBS.label
    resources: mem_mb=RUN_JOBS.memory, runtime=RUN_JOBS.minutes   # asked of a cluster; others: profiles/slurm
    group: group_on_cluster(workflow, "runs", RUN_JOBS.is_short)
    message: "{wildcards.study} {wildcards.variant}: member {wildcards.member}{params.label}"
    script: "../scripts/simulate_member.py"


rule aggregate_study:
    input:
        data=RUN_JOBS.study_files("runs", "nc"),
        costs=RUN_JOBS.study_files("costs/runs", "json"),
        done=RUN_JOBS.study_files("runs", "done"),
    output:
        data=RESULTS / "datasets/{chapter}_{study}.nc",
        costs=RESULTS / "costs/{chapter}_{study}.csv",
    wildcard_constraints: chapter=r"ch\d+"
    log: RESULTS / "logs/datasets/{chapter}_{study}.log"
    params: plan=RUN_JOBS.study_params
    group: group_on_cluster(workflow, "datasets")
    message: "dataset of {wildcards.study}"
    script: "../scripts/aggregate_study.py"


for _study in PLAN.studies:
    rule:
        name: _study
        localrule: True
        input: PRODUCTS.dataset(PLAN.dataset_name(_study))
