rule measure_extraction:
    input:
        folder="results/{platform}/simulated",
        truth="results/{platform}/truth.parquet",
    output:
        accuracy="results/{platform}/extraction_accuracy.parquet",
        detection="results/{platform}/detection.parquet",
        points="results/{platform}/detected_points.parquet",
    log:
        "results/logs/{platform}/measure_extraction.log",
    wildcard_constraints:
        platform="|".join(PROJECT.simulated) or "[^\\s\\S]",
    conda:
        "../../environment.yml"
    params:
        platform=settings,
        code=script_digest("measure_extraction"),
    script:
        "../../scripts/measure_extraction.py"
