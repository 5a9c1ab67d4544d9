# Robustness: one job for each hazard with every solver, one dataset, one figure.
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


    rule stability:
        input:
            data=[RESULTS / "datasets/stability.nc"],
        output:
            png=RESULTS / "figures/stability.png",
            pdf=RESULTS / "figures/stability.pdf",
            csv=RESULTS / "figures/stability.csv",
        log: RESULTS / "logs/figures/stability.log"
        params: plan=EVALUATION_JOBS.robustness_figure_params
        group: group_on_cluster(workflow, "figures")
        message: f"stability: {RESULTS}/figures/stability.png"
        script: "../scripts/draw_figure.py"


    rule robustness:
        input:
            data=[RESULTS / "datasets/stability.nc"],
        output:
            png=RESULTS / "figures/robustness.png",
            pdf=RESULTS / "figures/robustness.pdf",
            csv=RESULTS / "figures/robustness.csv",
        log: RESULTS / "logs/figures/robustness.log"
        params: plan=EVALUATION_JOBS.families_figure_params
        group: group_on_cluster(workflow, "figures")
        message: f"robustness: {RESULTS}/figures/robustness.png"
        script: "../scripts/draw_figure.py"
