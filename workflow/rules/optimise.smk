rule optimise:
    input:
        observations="results/{platform}/observations.parquet",
        outliers="results/{platform}/outliers.parquet",
        compiled=compiled,
    output:
        "results/{platform}/optima.parquet",
    log:
        "results/logs/{platform}/optimise.log",
    conda:
        "../../environment.yml"
    params:
        platform=settings,
        search=section("search"),
        code=script_digest("optimise"),
    script:
        "../../scripts/optimise.py"
