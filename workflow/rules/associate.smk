rule associate:
    input:
        "results/{platform}/points.parquet",
    output:
        observations="results/{platform}/observations.parquet",
        sigma="results/{platform}/navigation_sigma.parquet",
        frame="results/{platform}/map_frame.parquet",
    log:
        "results/logs/{platform}/associate.log",
    conda:
        "../../environment.yml"
    params:
        platform=settings,
        folder=lambda wildcards: str(PROJECT.folder(wildcards.platform)),
        code=script_digest("associate"),
    script:
        "../../scripts/associate.py"
