# Surveys with a known truth: platforms that are simulated, and the coverage study over many surveys.


rule simulate:
    input:
        lost=remade_if_lost("results/{platform}/simulated"),
    output:
        folder=directory("results/{platform}/simulated"),
        files="results/{platform}/simulated_files.txt",
        truth="results/{platform}/truth.parquet",
    log:
        "results/logs/{platform}/simulate.log",
    wildcard_constraints:
        platform=names_of(PROJECT.simulated + PROJECT.flown),
    conda:
        "../../environment.yml"
    threads: 2
    resources:
        **LIGHT,
    params:
        camera=lambda wildcards: settings(wildcards)["camera"],
        true_camera=lambda wildcards: settings(wildcards)["true_camera"],
        simulation=lambda wildcards: settings(wildcards)["simulation"],
        flight=lambda wildcards: settings(wildcards)["flight"],
        code=script_digest("simulate"),
    script:
        "../../scripts/simulate.py"


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
        platform=names_of(PROJECT.simulated),
    conda:
        "../../environment.yml"
    resources:
        **LIGHT,
    params:
        platform=settings,
        code=script_digest("measure_extraction"),
    script:
        "../../scripts/measure_extraction.py"


wildcard_constraints:
    regime="[A-Za-z0-9-]+",
    noise_model="[a-z]+",


COVERED = {  # what a cell's surveys depend on
    "platform": settings,
    "regime": lambda wildcards: STUDY.coverage.regimes[wildcards.regime].model_dump(
        mode="json", exclude={"noise_models"}
    ),
    "study": STUDY.coverage.model_dump(mode="json", include={"n_surveys", "seed"}),
}


rule coverage_part:  # a share of a cell's surveys, on one core: a job of its own wherever jobs are run
    input:
        compiled="results/compiled/{noise_model}.txt",
    output:
        temp(
            "results/coverage/parts/{platform}/{regime}/{noise_model}/{scatteritem}.parquet"
        ),
    log:
        "results/logs/coverage/{platform}/{regime}/{noise_model}/{scatteritem}.log",
    conda:
        "../../environment.yml"
    resources:
        **LONG,
    params:
        **COVERED,
        batch_size=STUDY.coverage.batch_size,
        work="results/coverage/work/{platform}-{regime}-{noise_model}/{scatteritem}",
        code=script_digest("coverage_part"),
    script:
        "../../scripts/coverage_part.py"


rule coverage_cell:
    input:
        parts=gather.coverage(
            "results/coverage/parts/{{platform}}/{{regime}}/{{noise_model}}/{scatteritem}.parquet"
        ),
    output:
        "results/coverage/cells/{platform}/{regime}/{noise_model}.parquet",
    log:
        "results/logs/coverage/{platform}/{regime}/{noise_model}.log",
    localrule: True  # it puts tables together
    conda:
        "../../environment.yml"
    resources:
        **LIGHT,
    params:
        **COVERED,
        code=script_digest("coverage_cell"),
    script:
        "../../scripts/coverage_cell.py"


rule coverage:
    input:
        cells=covered_cells,
        lost=remade_if_lost("results/coverage/figures"),
    output:
        surveys="results/coverage/surveys.parquet",
        coverage="results/coverage/coverage.parquet",
        summary="results/coverage/summary.parquet",
        csv="results/coverage/summary.csv",
        table="results/coverage/summary.md",
        figures=directory("results/coverage/figures"),
        files="results/coverage/figures_files.txt",
    log:
        "results/logs/coverage/coverage.log",
    conda:
        "../../environment.yml"
    resources:
        **LIGHT,
    params:
        pools=STUDY.coverage.pools,
        code=script_digest("coverage_summary"),
    script:
        "../../scripts/coverage_summary.py"  # numba imports whatever is called coverage
