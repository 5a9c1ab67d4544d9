# What effects cost: one job that measures the ladder, alone on the machine since it is timed, and its figure.
if LADDER:

    rule measure_effects:
        output:
            data=RESULTS / "datasets/effects.nc",
            costs=RESULTS / "costs/effects.json",
        log: RESULTS / "logs/datasets/effects.log"
        params: plan=canonical(effect_cost.plan(LADDER))
        threads: timed_threads()
        group: together("timed")
        message: "effects: every variant measured"
        script: "../scripts/effects.py"


    rule effects:
        input:
            data=RESULTS / "datasets/effects.nc",
            costs=RESULTS / "costs/effects.json",
        output:
            png=RESULTS / "figures/effects.png",
            pdf=RESULTS / "figures/effects.pdf",
            csv=RESULTS / "figures/effects.csv",
        log: RESULTS / "logs/figures/effects.log"
        params: plan=canonical(effect_cost.figure(LADDER, PLAN.tier))
        group: together("figures")
        message: f"effects: {RESULTS}/figures/effects.png"
        script: "../scripts/effects_figure.py"
