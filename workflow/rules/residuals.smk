rule residuals:
    input:
        observations="results/{platform}/observations.parquet",
        outliers="results/{platform}/outliers.parquet",
        optima="results/{platform}/optima.parquet",
        compiled=compiled,
    output:
        residuals="results/{platform}/residuals.parquet",
        points="results/{platform}/estimated_points.parquet",
    log:
        "results/logs/{platform}/residuals.log",
    conda:
        "../../environment.yml"
    params:
        platform=settings,
        code=script_digest("residuals"),
    script:
        "../../scripts/residuals.py"
