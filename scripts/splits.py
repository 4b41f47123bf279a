"""Compare the poses of many random pairs of disjoint subsets."""

from pathlib import Path

from adapter import stage

with stage(snakemake) as log:
    from linepose.config.experiments import RepeatabilitySection
    from linepose.config.platform import Platform
    from linepose.estimation.optimise import Search
    from linepose.experiments.accepted import read_accepted, read_reference
    from linepose.experiments.repeatability import random_splits
    from linepose.experiments.schemas import SPLITS
    from linepose.pipeline.batches import batch_ranges, inputs_digest, remove_finished, run_batches
    from linepose.pipeline.progress import shown
    from linepose.tables import write_table

    platform = Platform.model_validate(snakemake.params.platform)
    settings = RepeatabilitySection.model_validate(snakemake.params.repeatability)
    search = Search.model_validate(snakemake.params.search)
    data = read_accepted(platform, snakemake.input.observations, snakemake.input.outliers)
    reference = read_reference(data.accepted, snakemake.input.optima, snakemake.input.samples)
    size = settings.split_size or data.accepted.survey.n_observations // 2
    ranges = batch_ranges(settings.n_splits, 10)
    work = Path(snakemake.params.work) / inputs_digest(dict(snakemake.params.items()), snakemake.input)
    table = run_batches(
        lambda name: random_splits(data.accepted, reference.pose, size, ranges[name], snakemake.params.seed, search),
        list(ranges),
        work,
        SPLITS,
        snakemake.threads,
        shown(),
    )
    write_table(table, snakemake.output[0], SPLITS)
    remove_finished(work)
    log.info("%d splits, %.0f %% with p < 0.05", len(table), 100 * (table["p_value"] < 0.05).mean())
