rule basin_summary:
    input:
        "results/{platform}/basin.parquet",
    output:
        "results/{platform}/basin_summary.parquet",
    log:
        "results/logs/{platform}/basin_summary.log",
    conda:
        "../../environment.yml"
    params:
        basin=experiment("basin"),
        code=source_digest("linepose.experiments.basin"),
    script:
        "../../scripts/basin_summary.py"
