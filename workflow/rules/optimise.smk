rule optimise:
    input:
        observations="results/{platform}/observations.parquet",
        outliers="results/{platform}/outliers.parquet",
        compiled="results/compiled.txt",
    output:
        "results/{platform}/optima.parquet",
    params:
        platform=settings,
        search=section("search"),
        code=[source_digest("linepose.stages"), source_digest("linepose.likelihood.models")],
    log:
        "results/logs/{platform}/optimise.log",
    conda:
        "../../environment.yml"
    script:
        "../../scripts/optimise.py"
