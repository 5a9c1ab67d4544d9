# From datasets to verdicts on the statements of the thesis.
rule assess_claims:
    input:
        data=RESULT_JOBS.claims_data,
        costs=RESULT_JOBS.claims_costs,
        candidates=CANDIDATE_JOBS.claims_candidates,
    output:
        csv=RESULTS / "claims/{chapter}.csv",
        png=RESULTS / "claims/{chapter}.png",
        pdf=RESULTS / "claims/{chapter}.pdf",
        svg=RESULTS / "claims/{chapter}.svg",
    wildcard_constraints: chapter=r"ch\d+"
    log: RESULTS / "logs/claims/{chapter}.log"
    params: plan=RESULT_JOBS.claims_params
    group: group_on_cluster(workflow, "figures")
    message: "claims of {wildcards.chapter}: {output.png}"
    script: "../scripts/assess_claims.py"


rule claims:
    localrule: True
    input: PRODUCTS.all_claims()
