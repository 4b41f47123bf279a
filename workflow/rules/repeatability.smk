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
        code=[
            source_digest("linepose.experiments.repeatability"),
            source_digest("linepose.experiments.accepted"),
            source_digest("linepose.estimation.noise_models"),
        ],
    script:
        "../../scripts/repeatability.py"
