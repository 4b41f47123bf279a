rule prior:
    input:
        observations="results/{platform}/observations.parquet",
        outliers="results/{platform}/outliers.parquet",
        optima="results/{platform}/optima.parquet",
        samples="results/{platform}/mcmc",
        compiled=compiled,
    output:
        "results/{platform}/prior.parquet",
    log:
        "results/logs/{platform}/prior.log",
    conda:
        "../../environment.yml"
    params:
        platform=settings,
        code=script_digest("prior"),
    script:
        "../../scripts/prior.py"
