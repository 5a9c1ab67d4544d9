# What accuracy costs: one job a case and solver, timed, at most two at once.
def case_params(wildcards):
    return canonical(cases.job_plan(CASES[wildcards.case], wildcards.job))


def case_files(ending, folder):
    def files(wildcards):
        return [RESULTS / folder / f"{wildcards.case}/{job}.{ending}" for job in CASES[wildcards.case].jobs()]
    return files


def case_study(ending, folder):
    def file(wildcards):
        return RESULTS / folder / f"{PLAN.dataset_name(CASES[wildcards.case].study.name)}.{ending}"
    return file


@functools.cache
def all_tiers():
    return case_config.every_tier(CONFIG, PLAN)


def case_figure(wildcards):
    return canonical(case_config.figure_settings(CASES[wildcards.case], PLAN, all_tiers()))


rule price:
    output:
        data=RESULTS / "accuracy/{case}/{job}.nc",
        costs=RESULTS / "costs/accuracy/{case}/{job}.json",
    log: RESULTS / "logs/accuracy/{case}/{job}.log"
    params: plan=case_params, config=os.path.relpath(CONFIG), tier=PLAN.tier
    threads: timed_threads(at_once=2)
    priority: 1  # they take minutes: not at the end
    group: together("timed")
    message: "accuracy of {wildcards.case}: {wildcards.job}"
    script: "../scripts/price.py"


rule accuracy_figure:
    input:
        data=case_files("nc", "accuracy"),
        costs=case_files("json", "costs/accuracy"),
        study=case_study("nc", "datasets"),
        study_costs=case_study("csv", "costs"),
    output:
        png=RESULTS / "figures/accuracy_{case}.png",
        pdf=RESULTS / "figures/accuracy_{case}.pdf",
        csv=RESULTS / "figures/accuracy_{case}.csv",
        equal_error=RESULTS / "figures/accuracy_{case}_at_equal_error.csv",
    log: RESULTS / "logs/figures/accuracy_{case}.log"
    params: plan=case_figure
    group: together("figures")
    message: "accuracy_{wildcards.case}: {output.png}"
    script: "../scripts/accuracy.py"


if OVERVIEW:

    rule overview:
        input: [RESULTS / f"figures/accuracy_{case}.csv" for case in sorted(CASES)]
        output:
            png=RESULTS / "figures/overview.png",
            pdf=RESULTS / "figures/overview.pdf",
            csv=RESULTS / "figures/overview.csv",
        log: RESULTS / "logs/figures/overview.log"
        params: plan=canonical(case_config.overview(OVERVIEW, CASES, PLAN.tier))
        group: together("figures")
        message: f"overview: {RESULTS}/figures/overview.png"
        script: "../scripts/overview.py"


for _case in CASES:
    rule:
        name: f"accuracy_{_case}"
        localrule: True
        input: figure_files(f"accuracy_{_case}")


rule accuracy:
    localrule: True
    input: [file for case in CASES for file in figure_files(f"accuracy_{case}")]
