rule reject_outliers:
    input:
        "results/{platform}/observations.parquet",
        "results/compiled.txt",
    output:
        "results/{platform}/outliers.parquet",
    params:
        platform=settings,
        outliers=section("outliers"),
        search=section("search"),
        code=[source_digest("linepose.outliers"), source_digest("linepose.likelihood.models")],
    log:
        "results/logs/{platform}/reject_outliers.log",
    conda:
        "../../environment.yml"
    script:
        "../../scripts/reject_outliers.py"
