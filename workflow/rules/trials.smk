# Accuracy asked for, on trial: one timed job a scene, alone on the machine, and a figure; and the relations measured anew.
if DRAWS:

    def trial_params(wildcards):
        return canonical(validation.plan(DRAWS, wildcards.kind, int(wildcards.number)))


    def relation_params(wildcards):
        return canonical(measurement.plan(DRAWS, wildcards.kind))


    rule trial:
        output:
            data=RESULTS / "trials/{kind}_{number}.nc",
            costs=RESULTS / "costs/trials/{kind}_{number}.json",
        wildcard_constraints: kind="|".join(DRAWS["kinds"]), number=r"\d+"
        log: RESULTS / "logs/trials/{kind}_{number}.log"
        params: plan=trial_params
        threads: timed_threads()
        group: together("timed")
        message: "trial: {wildcards.kind} {wildcards.number}, solved to an accuracy, and judged"
        script: "../scripts/trial.py"


    rule trials:
        input:
            data=[RESULTS / f"trials/{name}.nc" for name in validation.names(DRAWS)],
            costs=[RESULTS / f"costs/trials/{name}.json" for name in validation.names(DRAWS)],
        output:
            data=RESULTS / "datasets/trials.nc",
            png=RESULTS / "figures/trials.png",
            pdf=RESULTS / "figures/trials.pdf",
            csv=RESULTS / "figures/trials.csv",
        log: RESULTS / "logs/figures/trials.log"
        params: plan=canonical(validation.figure(DRAWS, PLAN.tier))
        group: together("figures")
        message: f"trials: {RESULTS}/figures/trials.png"
        script: "../scripts/trials.py"


    rule measure_relations:
        output: RESULTS / "costs/relations/{kind}.csv",
        wildcard_constraints: kind="|".join(DRAWS["kinds"])
        log: RESULTS / "logs/relations/{kind}.log"
        params: plan=relation_params
        threads: timed_threads()
        group: together("timed")
        message: "relations of {wildcards.kind}: scenes on a ladder of every knob"
        script: "../scripts/measure_relations.py"


    rule relations:
        input: of_the_standard_tier, tables=[RESULTS / f"costs/relations/{kind}.csv" for kind in DRAWS["kinds"]]
        output: RESULTS / "costs/relations.yaml"
        log: RESULTS / "logs/relations.log"
        params: source=source_digest("contactsim.evaluation.calibration.fit")
        message: "relations, to be put in the place of src/contactsim/error_control/scaling.yaml: {output}"
        script: "../scripts/relations.py"
