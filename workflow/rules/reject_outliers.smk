rule reject_outliers:
    input:
        observations="results/{platform}/observations.parquet",
        compiled=compiled,
    output:
        "results/{platform}/outliers.parquet",
    log:
        "results/logs/{platform}/reject_outliers.log",
    conda:
        "../../environment.yml"
    params:
        platform=settings,
        outliers=section("outliers"),
        search=section("search"),
        code=script_digest("reject_outliers"),
    script:
        "../../scripts/reject_outliers.py"
