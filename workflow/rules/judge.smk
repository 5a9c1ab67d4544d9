# From datasets to verdicts on what the thesis states.
def claims_data(wildcards):
    studies = PLAN.claims_studies(wildcards.chapter)
    return [RESULTS / f"datasets/{PLAN.dataset_name(study)}.nc" for study in studies]


def claims_params(wildcards):
    return canonical(PLAN.claims_settings(wildcards.chapter))


rule judge:
    input: claims_data
    output:
        csv=RESULTS / "claims/{chapter}.csv",
        png=RESULTS / "claims/{chapter}.png",
        pdf=RESULTS / "claims/{chapter}.pdf",
    wildcard_constraints: chapter=r"ch\d+"
    log: RESULTS / "logs/claims/{chapter}.log"
    params: plan=claims_params
    group: together("figures")
    message: "claims of {wildcards.chapter}: {output.png}"
    script: "../scripts/claims.py"


rule claims:
    localrule: True
    input: all_claims
