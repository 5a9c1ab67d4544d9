# All results on one page, in small pictures for the docs, and in one folder to publish.
rule report:
    input: PAGES.report_inputs()
    output: RESULTS / "report.html"
    log: RESULTS / "logs/report.log"
    params: plan=PAGES.report_params, config=os.path.relpath(CONFIG)
    message: "report: {output}"
    script: "../scripts/write_report.py"


rule gallery:
    input: PAGES.report_inputs()
    output: RESULTS / "gallery/gallery.csv"
    log: RESULTS / "logs/gallery.log"
    params: plan=PAGES.gallery_params, config=os.path.relpath(CONFIG)
    message: f"gallery: {RESULTS}/gallery"
    script: "../scripts/write_gallery.py"


rule bundle:
    input: PAGES.bundle_files
    output: RESULTS / "bundle/SHA256SUMS"  # written last: with it the bundle is whole
    log: RESULTS / "logs/bundle.log"
    params: plan=PAGES.bundle_params
    message: f"bundle: {RESULTS}/bundle"
    script: "../scripts/write_bundle.py"
