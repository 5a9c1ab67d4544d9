# One rule for each figure, from the datasets that it draws.
for _name, _figure in PLAN.figures.items():
    _datasets = [PLAN.dataset_name(study) for study in _figure.studies]

    rule:
        name: _name
        input:
            data=[PRODUCTS.dataset(name) for name in _datasets],
            costs=[PRODUCTS.cost_table(name) for name in _datasets],
        output:
            **{ending: RESULTS / f"figures/{_name}.{ending}" for ending in _figure.endings},
        log: RESULTS / f"logs/figures/{_name}.log"
        params: plan=RESULT_JOBS.figure_params(_name)
        group: group_on_cluster(workflow, "figures")
        message: f"{_name}: {RESULTS}/figures/{_name}.png"
        script: "../scripts/draw_figure.py"
