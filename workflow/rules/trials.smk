# Error-controlled runs on random scenes: one timed job for each scene, alone on the machine, and a figure; and the fit of coverage factors and relations.
if PRODUCTS.trials:

    rule solve_trial:
        output:
            data=RESULTS / "trials/{kind}_{number}.nc",
            costs=RESULTS / "costs/trials/{kind}_{number}.json",
        wildcard_constraints: kind="|".join(PRODUCTS.trials.kinds), number=r"\d+"
        log: RESULTS / "logs/trials/{kind}_{number}.log"
        params: plan=EVALUATION_JOBS.trial_params
        threads: timed_threads(PLAN, workflow.cores)
        group: group_on_cluster(workflow, "timed")
        message: "trial: {wildcards.kind} {wildcards.number}, solved to an accuracy, and its error measured"
        script: "../scripts/solve_trial.py"


    rule trials:
        input:
            data=EVALUATION_JOBS.trial_files("trials", "nc"),
            costs=EVALUATION_JOBS.trial_files("costs/trials", "json"),
        output:
            data=RESULTS / "datasets/trials.nc",
            png=RESULTS / "figures/trials.png",
            pdf=RESULTS / "figures/trials.pdf",
            svg=RESULTS / "figures/trials.svg",
            csv=RESULTS / "figures/trials.csv",
        log: RESULTS / "logs/figures/trials.log"
        params: plan=EVALUATION_JOBS.trials_figure_params
        group: group_on_cluster(workflow, "figures")
        message: f"trials: {RESULTS}/figures/trials.png"
        script: "../scripts/draw_trials.py"


    rule measure_scaling:
        output: RESULTS / "costs/relations/{kind}_{number}.csv",
        wildcard_constraints: kind="|".join(PRODUCTS.trials.kinds), number=r"\d+"
        log: RESULTS / "logs/relations/{kind}_{number}.log"
        params: plan=EVALUATION_JOBS.scaling_params
        threads: timed_threads(PLAN, workflow.cores)
        group: group_on_cluster(workflow, "timed")
        message: "scaling: {wildcards.kind} {wildcards.number}, solved on several grids and increments"
        script: "../scripts/measure_scaling.py"


    rule fit_scaling:
        input: EVALUATION_JOBS.full_tier, tables=EVALUATION_JOBS.scaling_files
        output: RESULTS / "costs/relations.json"
        log: RESULTS / "logs/relations.log"
        params: source=code_digest("fit_scaling")
        message: "coverage factors and relations, to replace src/contactsim/error_control/scaling.json: {output}"
        script: "../scripts/fit_scaling.py"
