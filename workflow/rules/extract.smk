rule extract:
    input:
        lambda wildcards: f"results/datasets/{PROJECT.platforms[wildcards.platform].source.dataset}.csv",
    output:
        "results/{platform}/points.parquet",
    log:
        "results/logs/{platform}/extract.log",
    conda:
        "../../environment.yml"
    params:
        platform=settings,
        folder=lambda wildcards: str(PROJECT.folder(wildcards.platform)),
        code=source_digest("linepose.extraction.labelled_views"),
    script:
        "../../scripts/extract.py"
