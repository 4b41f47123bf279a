rule diagnose:
    input:
        optima="results/{platform}/optima.parquet",
        samples="results/{platform}/mcmc",
    output:
        diagnostics="results/{platform}/diagnostics.parquet",
        pose="results/{platform}/pose.parquet",
    params:
        platform=settings,
        code=source_digest("linepose.stages"),
    log:
        "results/logs/{platform}/diagnose.log",
    conda:
        "../../environment.yml"
    script:
        "../../scripts/diagnose.py"
