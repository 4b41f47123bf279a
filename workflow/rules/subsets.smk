rule subsets:
    input:
        observations="results/{platform}/observations.parquet",
        outliers="results/{platform}/outliers.parquet",
        compiled=compiled,
    output:
        "results/{platform}/subsets.parquet",
    log:
        "results/logs/{platform}/subsets.log",
    conda:
        "../../environment.yml"
    threads: 2
    params:
        platform=settings,
        subsets=experiment("subsets"),
        file=platform_file,
        search=section("search"),
        sampling=sampling,
        seed=STUDY.seed,
        code=script_digest("subsets"),
    script:
        "../../scripts/subsets.py"
