# Error-controlled runs on random scenes: one timed job for each scene, alone on the machine, and a figure; and the fit of the scaling relations.
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
        output: RESULTS / "costs/relations/{kind}.csv",
        wildcard_constraints: kind="|".join(PRODUCTS.trials.kinds)
        log: RESULTS / "logs/relations/{kind}.log"
        params: plan=EVALUATION_JOBS.scaling_params
        threads: timed_threads(PLAN, workflow.cores)
        group: group_on_cluster(workflow, "timed")
        message: "scaling of {wildcards.kind}: scenes solved with several values of each setting"
        script: "../scripts/measure_scaling.py"


    rule fit_scaling:
        input: EVALUATION_JOBS.full_tier, tables=[RESULTS / f"costs/relations/{kind}.csv" for kind in PRODUCTS.trials.kinds]
        output: RESULTS / "costs/relations.yaml"
        log: RESULTS / "logs/relations.log"
        params: source=code_digest("fit_scaling")
        message: "scaling relations, to replace src/contactsim/error_control/scaling.yaml: {output}"
        script: "../scripts/fit_scaling.py"
