# Every solver on every hazard: one job a hazard, one dataset, one map.
if HAZARDS:

    def hazard_params(wildcards):
        return canonical(survey.job_settings(HAZARDS, wildcards.hazard))


    rule hazard:
        output: RESULTS / "stability/{hazard}.nc"
        log: RESULTS / "logs/stability/{hazard}.log"
        params: plan=hazard_params
        group: together("hazards")
        message: "hazard {wildcards.hazard}: every solver, every severity"
        script: "../scripts/hazard.py"


    rule stability_dataset:
        input: survey.map_settings(HAZARDS, PLAN)["paths"]
        output: RESULTS / "datasets/stability.nc"
        log: RESULTS / "logs/datasets/stability.log"
        params: plan=canonical(survey.map_settings(HAZARDS, PLAN))
        group: together("figures")
        message: "dataset of stability"
        script: "../scripts/stability.py"


    rule stability:
        input:
            data=[RESULTS / "datasets/stability.nc"],
        output:
            png=RESULTS / "figures/stability.png",
            pdf=RESULTS / "figures/stability.pdf",
            csv=RESULTS / "figures/stability.csv",
        log: RESULTS / "logs/figures/stability.log"
        params: plan=canonical(survey.map_figure(HAZARDS, PLAN))
        group: together("figures")
        message: f"stability: {RESULTS}/figures/stability.png"
        script: "../scripts/figure.py"
