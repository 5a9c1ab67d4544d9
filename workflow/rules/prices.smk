# What accuracy costs: one timed job for each scene, alone on the machine, and a figure.
if PRODUCTS.prices:

    rule measure_price:
        output:
            data=RESULTS / "prices/{scene}.nc",
            costs=RESULTS / "costs/prices/{scene}.json",
        wildcard_constraints: scene="|".join(PRODUCTS.prices.scenes)
        log: RESULTS / "logs/prices/{scene}.log"
        params: plan=EVALUATION_JOBS.price_params
        threads: timed_threads(PLAN, workflow.cores)
        group: group_on_cluster(workflow, "timed")
        message: "price of accuracy: {wildcards.scene}, solved to smaller and smaller errors"
        script: "../scripts/measure_price.py"


    rule price_of_accuracy:
        input:
            data=EVALUATION_JOBS.price_files("prices", "nc"),
            costs=EVALUATION_JOBS.price_files("costs/prices", "json"),
        output:
            png=RESULTS / "figures/price_of_accuracy.png",
            pdf=RESULTS / "figures/price_of_accuracy.pdf",
            svg=RESULTS / "figures/price_of_accuracy.svg",
            csv=RESULTS / "figures/price_of_accuracy.csv",
        log: RESULTS / "logs/figures/price_of_accuracy.log"
        params: plan=EVALUATION_JOBS.prices_figure_params
        group: group_on_cluster(workflow, "figures")
        message: f"price_of_accuracy: {RESULTS}/figures/price_of_accuracy.png"
        script: "../scripts/draw_prices.py"
