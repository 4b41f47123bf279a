rule truth_error:
    input:
        optima="results/{platform}/optima.parquet",
        samples="results/{platform}/mcmc",
        truth="results/{platform}/truth.parquet",
    output:
        "results/{platform}/truth_error.parquet",
    log:
        "results/logs/{platform}/truth_error.log",
    conda:
        "../../environment.yml"
    params:
        code=script_digest("truth_error"),
    script:
        "../../scripts/truth_error.py"
