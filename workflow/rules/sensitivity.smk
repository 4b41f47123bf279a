rule sensitivity:
    input:
        observations="results/{platform}/observations.parquet",
        outliers="results/{platform}/outliers.parquet",
        other_observations=of_others("sensitivity", "observations"),
        other_outliers=of_others("sensitivity", "outliers"),
        compiled=compiled,
    output:
        "results/{platform}/sensitivity.parquet",
    log:
        "results/logs/{platform}/sensitivity.log",
    conda:
        "../../environment.yml"
    params:
        platform=settings,
        others=settings_of_others("sensitivity"),
        search=section("search"),
        code=[
            source_digest("linepose.experiments.sensitivity"),
            source_digest("linepose.likelihood.pixels"),
            source_digest("linepose.experiments.accepted"),
            source_digest("linepose.estimation.noise_models"),
        ],
    script:
        "../../scripts/sensitivity.py"
