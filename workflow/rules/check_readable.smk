rule check_readable:
    input:
        lambda wildcards: PROJECT.record(wildcards.platform),
    output:
        touch("results/logs/{platform}/check_readable.passed"),
    log:
        "results/logs/{platform}/check_readable.log",
    conda:
        "../../environment.yml"
    params:
        platform=settings,
        folder=lambda wildcards: str(PROJECT.folder(wildcards.platform)),
        code=script_digest("check_readable"),
    script:
        "../../scripts/check_readable.py"
