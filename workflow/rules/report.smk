def reported(_):
    """Every result that the report's summaries and sections rest on."""
    always = ["observations", "outliers", "optima", "pose", "diagnostics", "residuals"]
    return [
        file for platform in PLATFORMS for file in experiment_results(platform)
    ] + expand("results/{platform}/{name}.parquet", platform=PLATFORMS, name=always)


rule report:
    input:
        results=reported,
        samples=expand("results/{platform}/mcmc", platform=PLATFORMS),
        figures=expand("results/{platform}/figures", platform=PLATFORMS),
    output:
        report(
            "results/report.html",
            caption="../report/report.rst",
            category="Report",
            labels={"result": "summary of all platforms"},
        ),
    log:
        "results/logs/report.log",
    conda:
        "../../environment.yml"
    params:
        platforms={
            name: PROJECT.platforms[name].model_dump(mode="json") for name in PLATFORMS
        },
        study=STUDY.model_dump(mode="json"),
        further_pages=FURTHER_PAGES,
        code=script_digest("report"),
    script:
        "../../scripts/report.py"
