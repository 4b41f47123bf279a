rule compile:
    output:
        "results/compiled/{noise_model}.txt",
    log:
        "results/logs/compile_{noise_model}.log",
    conda:
        "../../environment.yml"
    params:
        code=script_digest("compile"),
    script:
        "../../scripts/compile.py"
