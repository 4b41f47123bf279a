rule check_data:
    input:
        lambda wildcards: PROJECT.files(wildcards.dataset),
    output:
        "results/datasets/{dataset}.csv",
    log:
        "results/logs/check_data_{dataset}.log",
    conda:
        "../../environment.yml"
    params:
        folder=lambda wildcards: str(PROJECT.folders[wildcards.dataset]),
        sha256=lambda wildcards: PROJECT.sums(wildcards.dataset),
        code=script_digest("check_data"),
    script:
        "../../scripts/check_data.py"
