"""Estimate from many surveys with a known truth; a killed run goes on where it was."""

from pathlib import Path

from adapter import stage

with stage(snakemake) as log:
    from linepose.config.coverage import CoverageSection, RegimeSection
    from linepose.config.platform import Platform
    from linepose.experiments.coverage import COVERAGE_SURVEYS, Cell
    from linepose.pipeline.batches import batch_ranges, inputs_digest, remove_finished, run_batches
    from linepose.tables import write_table

    platform = Platform.model_validate(snakemake.params.platform)
    study = CoverageSection.model_validate(snakemake.params.study)
    regime = RegimeSection.model_validate(snakemake.params.regime)
    cell = Cell(
        *(snakemake.wildcards.platform, snakemake.wildcards.regime, snakemake.wildcards.noise_model),
        platform.intrinsics(),
        platform.simulation,
        platform.start_pose(),
        regime,
        study.seed,
        regime.with_faults,
        regime.hand_measured_prior,
    )
    cell.compile()
    ranges = batch_ranges(regime.n_surveys or study.n_surveys, snakemake.params.batch_size)
    told = {key: value for key, value in snakemake.params.items() if key != "batch_size"}
    work = Path(snakemake.params.work) / inputs_digest(told, [])
    table = run_batches(lambda name: cell.rows(ranges[name]), list(ranges), work, COVERAGE_SURVEYS, snakemake.threads)
    write_table(table, snakemake.output[0], COVERAGE_SURVEYS)
    remove_finished(work)
    held = [(table["credibility"] < nominal).mean() for nominal in (0.68, 0.95)]
    log.info("%d surveys: 68 %% holds the truth in %.2f, 95 %% in %.2f", len(table), *held)
