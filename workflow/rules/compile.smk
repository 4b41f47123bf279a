rule compile:
    output:
        "results/compiled/{noise_model}.txt",
    log:
        "results/logs/compile_{noise_model}.log",
    conda:
        "../../environment.yml"
    params:
        code=source_digest("linepose.estimation.warm_up"),
    script:
        "../../scripts/compile.py"
