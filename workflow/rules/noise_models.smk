rule noise_models:
    input:
        observations="results/{platform}/observations.parquet",
        outliers="results/{platform}/outliers.parquet",
        other_observations=of_others("noise_models", "observations"),
        other_outliers=of_others("noise_models", "outliers"),
        compiled=expand("results/compiled/{noise_model}.txt", noise_model=NOISE_MODELS),
    output:
        estimates="results/{platform}/noise_models.parquet",
        identifiability="results/{platform}/identifiability.parquet",
        weights="results/{platform}/weights.parquet",
    log:
        "results/logs/{platform}/noise_models.log",
    conda:
        "../../environment.yml"
    threads: 2
    params:
        platform=settings,
        others=settings_of_others("noise_models"),
        robust_steps=lambda wildcards: PROJECT.platforms[
            wildcards.platform
        ].experiments.noise_models.robust_steps,
        repeatability=experiment("repeatability"),
        file=platform_file,
        search=section("search"),
        sampling=section("sampling"),
        independence_sampling=section("independence_sampling"),
        seed=STUDY.seed,
        code=script_digest("noise_models"),
    script:
        "../../scripts/noise_models.py"
