rule diagnose:
    input:
        optima="results/{platform}/optima.parquet",
        samples="results/{platform}/mcmc",
    output:
        diagnostics="results/{platform}/diagnostics.parquet",
        pose="results/{platform}/pose.parquet",
    log:
        "results/logs/{platform}/diagnose.log",
    conda:
        "../../environment.yml"
    params:
        platform=settings,
        sampling=sampling,
        code=script_digest("diagnose"),
    script:
        "../../scripts/diagnose.py"
