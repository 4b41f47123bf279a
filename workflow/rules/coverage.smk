wildcard_constraints:
    regime="[A-Za-z0-9-]+",
    noise_model="[a-z]+",


def covered_cells(_):
    """Every platform, regime and noise model of the coverage study."""
    cells = [
        f"results/coverage/cells/{platform}/{regime}/{model}.parquet"
        for platform in PROJECT.covered
        for regime, section in STUDY.coverage.regimes.items()
        for model in section.noise_models
    ]
    if not cells:
        raise WorkflowError(
            "config/config.yaml: coverage: found no regime or no simulated platform, expected at least one of each; "
            "add them under coverage.regimes and platforms"
        )
    return cells


rule coverage_cell:
    input:
        compiled=expand("results/compiled/{noise_model}.txt", noise_model=NOISE_MODELS),
    output:
        "results/coverage/cells/{platform}/{regime}/{noise_model}.parquet",
    log:
        "results/logs/coverage/{platform}/{regime}/{noise_model}.log",
    conda:
        "../../environment.yml"
    threads: workflow.cores or 1
    params:
        platform=settings,
        regime=lambda wildcards: STUDY.coverage.regimes[wildcards.regime].model_dump(
            mode="json", exclude={"noise_models"}
        ),
        study=STUDY.coverage.model_dump(
            mode="json", include={"n_surveys", "n_draws", "seed"}
        ),
        batch_size=STUDY.coverage.batch_size,
        work="results/coverage/work/{platform}-{regime}-{noise_model}",
        code=script_digest("coverage_cell"),
    script:
        "../../scripts/coverage_cell.py"


rule coverage:
    input:
        cells=covered_cells,
    output:
        surveys="results/coverage/surveys.parquet",
        coverage="results/coverage/coverage.parquet",
        summary="results/coverage/summary.parquet",
        csv="results/coverage/summary.csv",
        table="results/coverage/summary.md",
        figures=directory("results/coverage/figures"),
    log:
        "results/logs/coverage/coverage.log",
    conda:
        "../../environment.yml"
    params:
        code=script_digest("coverage_summary"),
    script:
        "../../scripts/coverage_summary.py"  # numba imports whatever is called coverage
