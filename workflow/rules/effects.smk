# Cost of effects: one job that measures them, alone on the machine since it is timed, and its figure.
if PRODUCTS.effects:

    rule measure_effects:
        output:
            data=RESULTS / "datasets/effects.nc",
            costs=RESULTS / "costs/effects.json",
        log: RESULTS / "logs/datasets/effects.log"
        params: plan=EVALUATION_JOBS.effects_params
        threads: timed_threads(PLAN, workflow.cores)
        group: group_on_cluster(workflow, "timed")
        message: "effects: the cost of each"
        script: "../scripts/measure_effects.py"


    rule effects:
        input:
            data=RESULTS / "datasets/effects.nc",
            costs=RESULTS / "costs/effects.json",
        output:
            png=RESULTS / "figures/effects.png",
            pdf=RESULTS / "figures/effects.pdf",
            svg=RESULTS / "figures/effects.svg",
            csv=RESULTS / "figures/effects.csv",
        log: RESULTS / "logs/figures/effects.log"
        params: plan=EVALUATION_JOBS.effects_figure_params
        group: group_on_cluster(workflow, "figures")
        message: f"effects: {RESULTS}/figures/effects.png"
        script: "../scripts/draw_effects.py"
