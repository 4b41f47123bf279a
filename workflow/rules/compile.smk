rule compile:
    output:
        "results/compiled.txt",
    log:
        "results/logs/compile.log",
    conda:
        "../../environment.yml"
    params:
        code=source_digest("linepose.likelihood.warm_up"),
    script:
        "../../scripts/compile.py"
