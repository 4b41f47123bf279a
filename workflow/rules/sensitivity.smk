rule sensitivity:
    input:
        observations="results/{platform}/observations.parquet",
        outliers="results/{platform}/outliers.parquet",
        other_observations=lambda wildcards: expand(
            "results/{other}/observations.parquet", other=others(wildcards)
        ),
        other_outliers=lambda wildcards: expand(
            "results/{other}/outliers.parquet", other=others(wildcards)
        ),
        compiled="results/compiled.txt",
    output:
        "results/{platform}/sensitivity.parquet",
    log:
        "results/logs/{platform}/sensitivity.log",
    conda:
        "../../environment.yml"
    params:
        platform=settings,
        others=lambda wildcards: {
            key: PROJECT.platforms[key].model_dump(
                mode="json",
                exclude={"description", "published", "experiments", "map_frame"},
            )
            for key in others(wildcards)
        },
        search=section("search"),
        code=[
            source_digest("linepose.experiments.sensitivity"),
            source_digest("linepose.likelihood.pixels"),
            source_digest("linepose.experiments.accepted"),
            source_digest("linepose.likelihood.models"),
        ],
    script:
        "../../scripts/sensitivity.py"
