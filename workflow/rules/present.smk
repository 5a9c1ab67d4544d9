# From runs to one dataset a study, and from datasets to figures.
def study_runs(ending, folder):
    def files(wildcards):
        runs = PLAN.studies[wildcards.study].runs()
        return [RESULTS / folder / f"{run.stem}.{ending}" for run in runs]
    return files


def study_params(wildcards):
    return canonical(PLAN.study_settings(wildcards.study))


rule aggregate:
    input:
        data=study_runs("nc", "runs"),
        costs=study_runs("json", "costs/runs"),
        done=study_runs("done", "runs"),
    output:
        data=RESULTS / "datasets/{chapter}_{study}.nc",
        costs=RESULTS / "costs/{chapter}_{study}.csv",
    wildcard_constraints: chapter=r"ch\d+"
    log: RESULTS / "logs/datasets/{chapter}_{study}.log"
    params: plan=study_params
    group: together("datasets")
    message: "dataset of {wildcards.study}"
    script: "../scripts/aggregate.py"


for _name, _figure in PLAN.figures.items():
    _data = [PLAN.dataset_name(study) for study in _figure.studies]

    rule:
        name: _name
        input:
            data=[RESULTS / f"datasets/{name}.nc" for name in _data],
            costs=[RESULTS / f"costs/{name}.csv" for name in _data],
        output:
            png=RESULTS / f"figures/{_name}.png",
            pdf=RESULTS / f"figures/{_name}.pdf",
            csv=RESULTS / f"figures/{_name}.csv",
            **{kind: RESULTS / f"figures/{_name}.{kind}" for kind in _figure.endings[3:]},
        log: RESULTS / f"logs/figures/{_name}.log"
        params: plan=canonical(PLAN.figure_settings(_name))
        group: together("figures")
        message: f"{_name}: {RESULTS}/figures/{_name}.png"
        script: "../scripts/figure.py"


for _study in PLAN.studies:
    rule:
        name: _study
        localrule: True
        input: RESULTS / f"datasets/{PLAN.dataset_name(_study)}.nc"
