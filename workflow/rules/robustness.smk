# Robustness: one job for each hazard with every solver, one dataset, two figures.
if PRODUCTS.hazards:

    rule survey_hazard:
        output: RESULTS / "stability/{hazard}.nc"
        log: RESULTS / "logs/stability/{hazard}.log"
        params: plan=EVALUATION_JOBS.hazard_params
        group: group_on_cluster(workflow, "hazards")
        message: "hazard {wildcards.hazard}: every solver, every severity"
        script: "../scripts/survey_hazard.py"


    rule gather_hazards:
        input: EVALUATION_JOBS.hazard_files()
        output: RESULTS / "datasets/stability.nc"
        log: RESULTS / "logs/datasets/stability.log"
        params: plan=EVALUATION_JOBS.robustness_params
        group: group_on_cluster(workflow, "figures")
        message: "dataset of stability"
        script: "../scripts/gather_hazards.py"


    for _figure in ("robustness", "stability"):
        rule:
            name: _figure
            input:
                data=[RESULTS / "datasets/stability.nc"],
            output:
                png=RESULTS / f"figures/{_figure}.png",
                pdf=RESULTS / f"figures/{_figure}.pdf",
                svg=RESULTS / f"figures/{_figure}.svg",
                csv=RESULTS / f"figures/{_figure}.csv",
            log: RESULTS / f"logs/figures/{_figure}.log"
            params: plan=EVALUATION_JOBS.survey_figure_params(_figure)
            group: group_on_cluster(workflow, "figures")
            message: f"{_figure}: {RESULTS}/figures/{_figure}.png"
            script: "../scripts/draw_figure.py"
