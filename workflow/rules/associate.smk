rule associate:
    input:
        points="results/{platform}/points.parquet",
        covariances=lambda wildcards: FOLDERS[PLATFORMS[wildcards.platform].source.dataset]
        / PLATFORMS[wildcards.platform].source.covariances,
    output:
        observations="results/{platform}/observations.parquet",
        sigma="results/{platform}/navigation_sigma.parquet",
    params:
        platform=settings,
        code=source_digest("linepose.navigation"),
    log:
        "results/logs/{platform}/associate.log",
    conda:
        "../../environment.yml"
    script:
        "../../scripts/associate.py"
