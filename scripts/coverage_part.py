"""Estimate from a share of a cell's surveys with a known truth; a killed run goes on where it was."""

from pathlib import Path

from adapter import stage

with stage(snakemake) as log:
    from linepose.config.coverage import CoverageSection, RegimeSection
    from linepose.config.platform import Platform
    from linepose.experiments.coverage import COVERAGE_SURVEYS, Cell
    from linepose.pipeline.batches import batch_ranges, inputs_digest, remove_finished, run_batches, share_of
    from linepose.tables import write_table

    params = dict(snakemake.params.items())
    platform = Platform.model_validate(params["platform"])
    study = CoverageSection.model_validate(params["study"])
    regime = RegimeSection.model_validate(params["regime"])
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
    share = share_of(regime.n_surveys or study.n_surveys, snakemake.wildcards.scatteritem)
    ranges = {name: share[one.start : one.stop] for name, one in batch_ranges(len(share), params["batch_size"]).items()}
    told = {key: value for key, value in params.items() if key != "batch_size"}
    work = Path(params["work"]) / inputs_digest(told, [])
    table = run_batches(lambda name: cell.rows(ranges[name]), list(ranges), work, COVERAGE_SURVEYS, snakemake.threads)
    write_table(table, snakemake.output[0], COVERAGE_SURVEYS)
    remove_finished(work)
    log.info("%d surveys", len(table))
