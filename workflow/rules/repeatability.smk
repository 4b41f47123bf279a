rule repeatability:
    input:
        observations="results/{platform}/observations.parquet",
        outliers="results/{platform}/outliers.parquet",
        compiled=compiled,
    output:
        "results/{platform}/repeatability.parquet",
    log:
        "results/logs/{platform}/repeatability.log",
    conda:
        "../../environment.yml"
    threads: 2
    params:
        platform=settings,
        repeatability=experiment("repeatability"),
        file=platform_file,
        search=section("search"),
        sampling=sampling,
        seed=STUDY.seed,
        code=script_digest("repeatability"),
    script:
        "../../scripts/repeatability.py"
