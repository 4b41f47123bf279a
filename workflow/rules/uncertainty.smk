rule uncertainty:
    input:
        optima="results/{platform}/optima.parquet",
        poses="results/{platform}/pose.parquet",
    output:
        "results/{platform}/uncertainty.parquet",
    log:
        "results/logs/{platform}/uncertainty.log",
    conda:
        "../../environment.yml"
    params:
        code=script_digest("uncertainty"),
    script:
        "../../scripts/uncertainty.py"
