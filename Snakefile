# The targets of the workflow; `snakemake` without arguments lists them.
include: "workflow/rules/common.smk"


rule targets:
    localrule: True
    input: PAGES.list_targets


include: "workflow/rules/simulate.smk"
include: "workflow/rules/figures.smk"
include: "workflow/rules/claims.smk"
include: "workflow/rules/work_precision.smk"
include: "workflow/rules/prices.smk"
include: "workflow/rules/robustness.smk"
include: "workflow/rules/effects.smk"
include: "workflow/rules/effect_maps.smk"
include: "workflow/rules/trials.smk"
include: "workflow/rules/identification.smk"
include: "workflow/rules/report.smk"


rule all:
    input: PRODUCTS.all_figures(), PRODUCTS.all_claims(), RESULTS / "report.html"


rule unknown_target:
    output: "{name}"
    wildcard_constraints: name=r"[A-Za-z0-9_.=-]+"
    input: PAGES.refuse_target


if workflow.is_main_process:
    check_all_outputs(workflow, RESULTS)
