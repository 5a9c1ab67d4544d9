# All that was found on one page, and the same in small pictures for the README.
_accuracy = {f"accuracy_{name}": case.settings for name, case in CASES.items()} | ({"trials": DRAWS} if DRAWS else {})
OTHER_FIGURES = {
    "accuracy": _accuracy | ({"overview": OVERVIEW} if OVERVIEW else {}),
    "stability": {"stability": HAZARDS} if HAZARDS else {},
    "effects": ({"effects": LADDER} if LADDER else {}) | ({"effect_maps": MAPS} if MAPS else {}),
}
OTHER_TITLES = {name: one["title"] for group in OTHER_FIGURES.values() for name, one in group.items()}


def report_inputs():
    studies = [PLAN.dataset_name(name) for name in PLAN.studies]
    data = [RESULTS / f"{folder}/{name}.{end}" for name in studies for folder, end in (("datasets", "nc"), ("costs", "csv"))]
    return data + [file for file in all_figures(None) if file.suffix == ".png"] + all_claims(None)


def report_params(wildcards):
    texts = [file.read_text(encoding="utf-8") for file in sorted(CONFIG.parent.glob("workflow/rules/*.smk"))]
    return canonical(report.settings(PLAN, OTHER_FIGURES, "".join(texts)))


def gallery_params(wildcards):
    return canonical(gallery.settings(PLAN, OTHER_TITLES))


rule report:
    input: report_inputs()
    output: RESULTS / "report.html"
    log: RESULTS / "logs/report.log"
    params: plan=report_params, config=os.path.relpath(CONFIG)
    message: "report: {output}"
    script: "../scripts/report.py"


rule gallery:
    input: report_inputs()
    output: RESULTS / "gallery/gallery.csv"
    log: RESULTS / "logs/gallery.log"
    params: plan=gallery_params, config=os.path.relpath(CONFIG)
    message: f"gallery: {RESULTS}/gallery"
    script: "../scripts/gallery.py"
