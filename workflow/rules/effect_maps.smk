# What leaving effects out changes: one job a map, and their figure; and the maps as the package keeps them.
if MAPS:

    def map_params(wildcards):
        return canonical(effect_survey.plan(MAPS, wildcards.map))


    rule measure_map:
        output: RESULTS / "effect_maps/{map}.nc"
        wildcard_constraints: map="|".join(MAPS["maps"])
        log: RESULTS / "logs/effect_maps/{map}.log"
        params: plan=map_params
        group: together("maps")
        priority: 1  # they take minutes: not at the end
        message: "effect map {wildcards.map}: with and without, everywhere"
        script: "../scripts/measure_map.py"


    rule effect_maps:
        input: [RESULTS / f"effect_maps/{name}.nc" for name in sorted(MAPS["maps"])]
        output:
            png=RESULTS / "figures/effect_maps.png",
            pdf=RESULTS / "figures/effect_maps.pdf",
            csv=RESULTS / "figures/effect_maps.csv",
        log: RESULTS / "logs/figures/effect_maps.log"
        params: plan=canonical(effect_survey.figure(MAPS, PLAN.tier))
        group: together("figures")
        message: f"effect_maps: {RESULTS}/figures/effect_maps.png"
        script: "../scripts/effect_maps.py"


    rule freeze_maps:
        input: of_the_standard_tier, maps=[RESULTS / f"effect_maps/{name}.nc" for name in sorted(MAPS["maps"])]
        output: RESULTS / "effect_maps/effect_maps.yaml"
        log: RESULTS / "logs/effect_maps/freeze.log"
        params: plan=canonical(MAPS), source=source_digest("contactsim.evaluation.effects.survey")
        message: "maps, to be put in the place of src/contactsim/error_control/effect_maps.yaml: {output}"
        script: "../scripts/freeze_maps.py"
