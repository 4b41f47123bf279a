rule associate:
    input:
        points="results/{platform}/points.parquet",
        covariances=lambda wildcards: FOLDERS[
            PLATFORMS[wildcards.platform].source.dataset
        ]
        / PLATFORMS[wildcards.platform].source.covariances,
    output:
        observations="results/{platform}/observations.parquet",
        sigma="results/{platform}/navigation_sigma.parquet",
    log:
        "results/logs/{platform}/associate.log",
    conda:
        "../../environment.yml"
    params:
        platform=settings,
        code=source_digest("linepose.navigation"),
    script:
        "../../scripts/associate.py"
