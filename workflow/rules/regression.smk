REGRESSED = {
    key: PROJECT.platforms[key].published
    for key in PLATFORMS
    if PROJECT.platforms[key].published
}


rule regression:
    input:
        published=STUDY.published,
        pose=expand("results/{platform}/pose.parquet", platform=REGRESSED),
        outliers=expand("results/{platform}/outliers.parquet", platform=REGRESSED),
        sigma=expand("results/{platform}/navigation_sigma.parquet", platform=REGRESSED),
    output:
        parquet="results/regression.parquet",
        csv=report(
            "results/regression.csv",
            caption="../report/regression.rst",
            category="Report",
            labels={"result": "published and obtained numbers"},
        ),
    log:
        "results/logs/regression.log",
    conda:
        "../../environment.yml"
    params:
        published_as=REGRESSED,
        code=source_digest("linepose.tables.regression"),
    script:
        "../../scripts/regression.py"


rule check_regression:
    input:
        "results/regression.parquet",
    output:
        touch("results/logs/regression.passed"),
    log:
        "results/logs/check_regression.log",
    conda:
        "../../environment.yml"
    params:
        code=source_digest("linepose.tables.regression"),
    script:
        "../../scripts/check_regression.py"
