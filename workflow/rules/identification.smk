# Identification: one job for each candidate for the cell of the probe, their verdicts, and their figure.
if PRODUCTS.identification:

    rule simulate_candidate:
        output: CANDIDATE_JOBS.datasets("{candidate}")
        wildcard_constraints: candidate="|".join(CANDIDATE_JOBS.names)
        log: RESULTS / "logs/identification/{candidate}.log"
        params: plan=CANDIDATE_JOBS.candidate_params
        group: group_on_cluster(workflow, "candidates")
        message: "identification, candidate {wildcards.candidate}: slides of all interfaces"
        script: "../scripts/simulate_candidate.py"


    rule judge_candidates:
        input: CANDIDATE_JOBS.all_datasets()
        output: RESULTS / "identification/candidates.csv"
        log: RESULTS / "logs/identification/candidates.log"
        params: plan=CANDIDATE_JOBS.judgement_params
        group: group_on_cluster(workflow, "figures")
        message: "identification: statements in all candidates: {output}"
        script: "../scripts/judge_candidates.py"


    rule export_candidates:
        input: table=RESULTS / "identification/candidates.csv", tier=CANDIDATE_JOBS.full_tier
        output: RESULTS / "identification/package/candidates.csv"
        message: "candidates, to replace src/contactsim/analysis/candidates.csv: {output}"
        shell: "cp -- {input.table:q} {output:q}"


    rule identification:
        input: CANDIDATE_JOBS.table()
        output:
            png=RESULTS / "figures/identification.png",
            pdf=RESULTS / "figures/identification.pdf",
            svg=RESULTS / "figures/identification.svg",
            csv=RESULTS / "figures/identification.csv",
        log: RESULTS / "logs/figures/identification.log"
        params: plan=CANDIDATE_JOBS.figure_params
        group: group_on_cluster(workflow, "figures")
        message: f"identification: {RESULTS}/figures/identification.png"
        script: "../scripts/draw_identification.py"
