# Accuracy versus cost: one timed job for each case and solver, at most two at once.
rule measure_work_precision:
    output:
        data=RESULTS / "accuracy/{case}/{job}.nc",
        costs=RESULTS / "costs/accuracy/{case}/{job}.json",
    log: RESULTS / "logs/accuracy/{case}/{job}.log"
    params: plan=EVALUATION_JOBS.case_params, config=os.path.relpath(CONFIG), tier=PLAN.tier
    threads: timed_threads(PLAN, workflow.cores, at_once=2)
    priority: 1  # they take minutes: not at the end
    group: group_on_cluster(workflow, "timed")
    message: "accuracy of {wildcards.case}: {wildcards.job}"
    script: "../scripts/measure_work_precision.py"


rule draw_work_precision:
    input:
        data=EVALUATION_JOBS.case_files("accuracy", "nc"),
        costs=EVALUATION_JOBS.case_files("costs/accuracy", "json"),
        study=EVALUATION_JOBS.case_study,
        study_costs=EVALUATION_JOBS.case_study_costs,
        baselines=BASELINE_JOBS.package_tables,
    output:
        png=RESULTS / "figures/accuracy_{case}.png",
        pdf=RESULTS / "figures/accuracy_{case}.pdf",
        svg=RESULTS / "figures/accuracy_{case}.svg",
        csv=RESULTS / "figures/accuracy_{case}.csv",
        equal_error=RESULTS / "figures/accuracy_{case}_at_equal_error.csv",
    log: RESULTS / "logs/figures/accuracy_{case}.log"
    params: plan=EVALUATION_JOBS.case_figure_params
    group: group_on_cluster(workflow, "figures")
    message: "accuracy_{wildcards.case}: {output.png}"
    script: "../scripts/draw_work_precision.py"


if PRODUCTS.cases:

    rule export_baselines:
        input: data=BASELINE_JOBS.all_data, costs=BASELINE_JOBS.all_costs, tier=BASELINE_JOBS.kept_tier
        output: jobs=BASELINE_JOBS.table, cases=BASELINE_JOBS.case_tables()
        log: RESULTS / "logs/accuracy/export_baselines.log"
        params: plan=BASELINE_JOBS.export_params, source=code_digest("export_baselines")
        message: "baselines, to replace src/contactsim/evaluation/work_precision/baselines.csv and baseline_tables: {output.jobs}"
        script: "../scripts/export_baselines.py"


if PRODUCTS.overview:

    rule overview:
        input: [RESULTS / f"figures/accuracy_{case}.csv" for case in sorted(PRODUCTS.cases)]
        output:
            png=RESULTS / "figures/overview.png",
            pdf=RESULTS / "figures/overview.pdf",
            svg=RESULTS / "figures/overview.svg",
            csv=RESULTS / "figures/overview.csv",
        log: RESULTS / "logs/figures/overview.log"
        params: plan=EVALUATION_JOBS.overview_params
        group: group_on_cluster(workflow, "figures")
        message: f"overview: {RESULTS}/figures/overview.png"
        script: "../scripts/draw_overview.py"


for _case in PRODUCTS.cases:
    rule:
        name: f"accuracy_{_case}"
        localrule: True
        input: PRODUCTS.figure_files(f"accuracy_{_case}")


rule accuracy:
    localrule: True
    input: [file for case in PRODUCTS.cases for file in PRODUCTS.figure_files(f"accuracy_{case}")]
