rule extract:
    input:
        files=dataset_files,
        sums=lambda wildcards: STUDY.datasets[
            PLATFORMS[wildcards.platform].source.dataset
        ],
    output:
        "results/{platform}/points.parquet",
    log:
        "results/logs/{platform}/extract.log",
    conda:
        "../../environment.yml"
    params:
        platform=settings,
        folder=lambda wildcards: str(
            FOLDERS[PLATFORMS[wildcards.platform].source.dataset]
        ),
        code=source_digest("linepose.extraction.labelled_views"),
    script:
        "../../scripts/extract.py"
