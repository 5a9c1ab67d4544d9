# Neglecting effects: one job for each map, and their figure; and the maps in the form that the package contains.
if PRODUCTS.maps:

    rule measure_effect_map:
        output: RESULTS / "effect_maps/{map}.nc"
        wildcard_constraints: map="|".join(PRODUCTS.maps.maps)
        log: RESULTS / "logs/effect_maps/{map}.log"
        params: plan=EVALUATION_JOBS.map_params
        group: group_on_cluster(workflow, "maps")
        priority: 1  # they take minutes: not at the end
        message: "effect map {wildcards.map}: scenes with and without an effect"
        script: "../scripts/measure_effect_map.py"


    rule effect_maps:
        input: EVALUATION_JOBS.map_files()
        output:
            png=RESULTS / "figures/effect_maps.png",
            pdf=RESULTS / "figures/effect_maps.pdf",
            svg=RESULTS / "figures/effect_maps.svg",
            csv=RESULTS / "figures/effect_maps.csv",
        log: RESULTS / "logs/figures/effect_maps.log"
        params: plan=EVALUATION_JOBS.maps_figure_params
        group: group_on_cluster(workflow, "figures")
        message: f"effect_maps: {RESULTS}/figures/effect_maps.png"
        script: "../scripts/draw_effect_maps.py"


    rule export_effect_maps:
        input: EVALUATION_JOBS.full_tier, maps=EVALUATION_JOBS.map_files()
        output: RESULTS / "effect_maps/effect_maps.json"
        log: RESULTS / "logs/effect_maps/freeze.log"
        params: plan=EVALUATION_JOBS.maps_params, source=code_digest("measure_effect_map")
        message: "effect maps, to replace src/contactsim/error_control/effect_maps.json: {output}"
        script: "../scripts/export_effect_maps.py"
