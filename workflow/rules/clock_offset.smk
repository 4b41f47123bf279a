rule clock_offset:
    input:
        record=lambda wildcards: PROJECT.record(wildcards.platform),
        observations="results/{platform}/observations.parquet",
        outliers="results/{platform}/outliers.parquet",
        optima="results/{platform}/optima.parquet",
        samples="results/{platform}/mcmc",
        compiled=compiled,
    output:
        table="results/{platform}/clock_offset.parquet",
        samples="results/{platform}/clock_offset_samples.parquet",
    log:
        "results/logs/{platform}/clock_offset.log",
    conda:
        "../../environment.yml"
    threads: 2
    params:
        platform=settings,
        clock_offset=experiment("clock_offset"),
        folder=lambda wildcards: str(PROJECT.folder(wildcards.platform)),
        search=section("search"),
        sampling=sampling,
        seed=STUDY.seed,
        code=script_digest("clock_offset"),
    script:
        "../../scripts/clock_offset.py"
