rule sample:
    input:
        observations="results/{platform}/observations.parquet",
        outliers="results/{platform}/outliers.parquet",
        optima="results/{platform}/optima.parquet",
        compiled=compiled,
    output:
        directory("results/{platform}/mcmc"),
    log:
        "results/logs/{platform}/sample.log",
    conda:
        "../../environment.yml"
    threads: 2
    params:
        platform=settings,
        sampling=sampling,
        seed=STUDY.seed,
        code=script_digest("sample"),
    script:
        "../../scripts/sample.py"
