rule consistency:
    input:
        observations="results/{platform}/observations.parquet",
        outliers="results/{platform}/outliers.parquet",
        other_observations=of_others("noise_models", "observations"),
        other_outliers=of_others("noise_models", "outliers"),
        estimates="results/{platform}/noise_models.parquet",
        compiled=expand("results/compiled/{noise_model}.txt", noise_model=NOISE_MODELS),
    output:
        splits="results/{platform}/consistency.parquet",
        summary="results/{platform}/consistency_summary.parquet",
    log:
        "results/logs/{platform}/consistency.log",
    conda:
        "../../environment.yml"
    threads: 64  # as many as there are
    params:
        platform=settings,
        others=settings_of_others("noise_models"),
        noise_models=experiment("noise_models"),
        repeatability=experiment("repeatability"),
        file=platform_file,
        search=section("search"),
        seed=STUDY.seed,
        work="results/{platform}/work/consistency",
        code=script_digest("consistency"),
    script:
        "../../scripts/consistency.py"
