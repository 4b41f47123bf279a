rule extract:
    input:
        record=lambda wildcards: PROJECT.record(wildcards.platform),
        readable=readable,
    output:
        "results/{platform}/points.parquet",
    log:
        "results/logs/{platform}/extract.log",
    conda:
        "../../environment.yml"
    params:
        platform=settings,
        folder=lambda wildcards: str(PROJECT.folder(wildcards.platform)),
        code=script_digest("extract"),
    script:
        "../../scripts/extract.py"
