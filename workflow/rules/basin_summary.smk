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
        code=script_digest("basin_summary"),
    script:
        "../../scripts/basin_summary.py"
