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
        code=script_digest("sensitivity"),
    script:
        "../../scripts/sensitivity.py"
