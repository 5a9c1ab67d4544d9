# What can be made. `snakemake` alone lists it.
include: "workflow/rules/common.smk"


rule targets:
    localrule: True
    input: list_targets


include: "workflow/rules/simulate.smk"
include: "workflow/rules/present.smk"
include: "workflow/rules/accuracy.smk"
include: "workflow/rules/effects.smk"
include: "workflow/rules/trials.smk"
include: "workflow/rules/effect_maps.smk"
include: "workflow/rules/judge.smk"
include: "workflow/rules/stability.smk"
include: "workflow/rules/report.smk"
include: "workflow/rules/bundle.smk"


rule all:
    input: all_figures, all_claims, RESULTS / "report.html"


rule unknown_target:
    output: "{name}"
    wildcard_constraints: name=r"[A-Za-z0-9_]+"
    input: refuse_target
