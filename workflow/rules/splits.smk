rule splits:
    input:
        observations="results/{platform}/observations.parquet",
        outliers="results/{platform}/outliers.parquet",
        optima="results/{platform}/optima.parquet",
        samples="results/{platform}/mcmc",
        compiled=compiled,
    output:
        "results/{platform}/splits.parquet",
    log:
        "results/logs/{platform}/splits.log",
    conda:
        "../../environment.yml"
    threads: 64  # as many as there are
    params:
        platform=settings,
        repeatability=experiment("repeatability"),
        search=section("search"),
        seed=STUDY.seed,
        work="results/{platform}/work/splits",
        code=script_digest("splits"),
    script:
        "../../scripts/splits.py"
