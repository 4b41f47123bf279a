rule basin:
    input:
        observations="results/{platform}/observations.parquet",
        outliers="results/{platform}/outliers.parquet",
        optima="results/{platform}/optima.parquet",
        samples="results/{platform}/mcmc",
        compiled=compiled,
    output:
        "results/{platform}/basin.parquet",
    log:
        "results/logs/{platform}/basin.log",
    conda:
        "../../environment.yml"
    threads: 64  # as many as there are
    params:
        platform=settings,
        basin=experiment("basin"),
        search=section("search"),
        seed=STUDY.seed,
        work="results/{platform}/work/basin",
        code=script_digest("basin"),
    script:
        "../../scripts/basin.py"
