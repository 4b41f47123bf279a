rule compile:
    output:
        "results/compiled.txt",
    params:
        code=source_digest("linepose.likelihood.warm_up"),
    log:
        "results/logs/compile.log",
    conda:
        "../../environment.yml"
    script:
        "../../scripts/compile.py"
