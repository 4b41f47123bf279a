def reported(wildcards):
    """Every result that the report's summaries rest on."""
    always = ["observations", "outliers", "optima", "pose", "diagnostics", "residuals"]
    known = [
        file
        for platform in PLATFORMS
        for file in asked_for(platform)
        if Path(file).stem in ("splits", "leave_one_out")
    ]
    return known + expand(
        "results/{platform}/{name}.parquet", platform=PLATFORMS, name=always
    )


rule report:
    input:
        results=reported,
        samples=expand("results/{platform}/mcmc", platform=PLATFORMS),
        figures=expand("results/{platform}/figures", platform=PLATFORMS),
        regression="results/regression.parquet",
        tables=[
            file
            for file in (rules.published_tables.output if COMPARED else [])
            if file.endswith(".parquet")
        ],
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
        code=[
            source_digest("linepose.report.page"),
            source_digest("linepose.report.summary"),
        ],
        templates=files_digest("report/templates"),
    script:
        "../../scripts/report.py"
