"""Search for the optimum from starts near and far; a killed run goes on where it was."""

from pathlib import Path

from adapter import stage

with stage(snakemake) as log:
    from linepose.config.experiments import BasinSection
    from linepose.config.platform import Platform
    from linepose.estimation.optimise import Search
    from linepose.experiments.accepted import read_accepted, read_reference
    from linepose.experiments.basin import Sweep
    from linepose.experiments.schemas import BASIN
    from linepose.pipeline.batches import batch_ranges, inputs_digest, remove_finished, run_batches
    from linepose.pipeline.progress import shown
    from linepose.tables import write_table

    platform = Platform.model_validate(snakemake.params.platform)
    settings = BasinSection.model_validate(snakemake.params.basin)
    data = read_accepted(platform, snakemake.input.observations, snakemake.input.outliers)
    reference = read_reference(data.accepted, snakemake.input.optima, snakemake.input.samples)
    sweep = Sweep(
        data.accepted,
        reference.pose,
        reference.covariance,
        settings.grid(),
        snakemake.params.seed,
        Search.model_validate(snakemake.params.search),
        settings.success_threshold,
    )
    ranges = batch_ranges(settings.grid().n_cells, settings.batch_size)
    parts = {f"{name}-{part}": (name, cells) for name in settings.optimisers for part, cells in ranges.items()}
    work = Path(snakemake.params.work) / inputs_digest(dict(snakemake.params.items()), snakemake.input)
    table = run_batches(lambda part: sweep.rows(*parts[part]), list(parts), work, BASIN, snakemake.threads, shown())
    write_table(table, snakemake.output[0], BASIN)
    remove_finished(work)
    for name, rows in table.groupby("optimiser", sort=False):
        log.info("%s: %d of %d starts found the optimum", name, rows["success"].sum(), len(rows))
