# All results of the tier in one folder to deposit; its sums are written last, so with them it is whole.
PROJECT = ["CITATION.cff", "LICENSE", "environment.txt", "examples/reanalyse.py"]


def bundle_titles():
    titled = {name: figure.settings["title"] for name, figure in PLAN.figures.items()}
    titled |= {PLAN.dataset_name(name): study.settings["title"] for name, study in PLAN.studies.items()}
    return titled | OTHER_TITLES


def bundle_data():
    data = {PLAN.dataset_name(name): PLAN.study_settings(name) for name in PLAN.studies}
    data |= {"stability": survey.map_settings(HAZARDS, PLAN)} if HAZARDS else {}
    data |= {"effects": effect_cost.plan(LADDER)} if LADDER else {}
    return data | ({"trials": validation.figure(DRAWS, PLAN.tier)} if DRAWS else {})


def bundle_places():
    studies = [PLAN.dataset_name(name) for name in PLAN.studies]
    results = [RESULTS / f"datasets/{name}.nc" for name in (*studies, *STABILITY, *EFFECTS, *TRIALS)]
    results += [RESULTS / f"costs/{name}.csv" for name in studies] + [RESULTS / "report.html"]
    results += [RESULTS / f"figures/accuracy_{case}_at_equal_error.csv" for case in CASES]
    results += all_figures(None) + all_claims(None)
    project = [CONFIG.parent / name for name in PROJECT] + sorted([*CONFIG.glob("*.yaml"), *CONFIG.glob("*.md")])
    places = {str(file.relative_to(RESULTS)): file for file in results}
    return places | {str(file.relative_to(CONFIG.parent)): file for file in project}


def bundle_files(wildcards):
    return list(bundle_places().values())


def bundle_params(wildcards):
    places = bundle_places()
    project = {place: file.read_text(encoding="utf-8") for place, file in places.items() if RESULTS not in file.parents}
    shown = [PLAN.figure_settings(name) for name in PLAN.figures], [PLAN.claims_settings(name) for name in PLAN.claims]
    return canonical(
        {
            "tier": PLAN.tier,
            "titles": bundle_titles(),
            "files": list(places),
            "data": {name: digest(settings) for name, settings in bundle_data().items()},
            "shown": digest(shown),
            "project": digest(project),
            "source": source_digest("contactsim.publish.bundle"),
        }
    )


rule bundle:
    input: bundle_files
    output: RESULTS / "bundle/SHA256SUMS"
    log: RESULTS / "logs/bundle.log"
    params: plan=bundle_params
    message: f"bundle: {RESULTS}/bundle"
    script: "../scripts/bundle.py"
