"""Compare the poses of disjoint observations under the published and the shared noise model."""

from pathlib import Path

from adapter import stage

with stage(snakemake) as log:
    from linepose.config.experiments import NoiseModelsSection, RepeatabilitySection
    from linepose.config.platform import Platform
    from linepose.estimation.optimise import Search
    from linepose.experiments.accepted import named_pair, read_accepted, read_others
    from linepose.experiments.consistency import Comparisons, groups_of, summarise_consistency
    from linepose.experiments.noise_models import INLIERS
    from linepose.experiments.schemas import CONSISTENCY, CONSISTENCY_SUMMARY, NOISE_MODELS
    from linepose.pipeline.batches import inputs_digest, remove_finished, run_batches
    from linepose.pipeline.progress import shown
    from linepose.tables import read_table, write_table

    params, files = snakemake.params, snakemake.input
    platform, own = Platform.model_validate(params.platform), snakemake.wildcards.platform
    settings = NoiseModelsSection.model_validate(params.noise_models)
    repeatability = params.repeatability and RepeatabilitySection.model_validate(params.repeatability)
    data = read_accepted(platform, files.observations, files.outliers)
    others = read_others(params.others, files.other_observations, files.other_outliers)
    surveys = {own: data.accepted.survey} | {name: other.accepted.survey for name, other in others.items()}
    sets = {name: name for name in surveys} | {own: INLIERS}
    comparisons = Comparisons(
        groups_of(surveys, sets, platform.intrinsics(), read_table(files.estimates, NOISE_MODELS)),
        list(named_pair(data, repeatability, params.file).values()),
        platform.start_pose(),
        params.seed,
        Search.model_validate(params.search),
    )
    parts = comparisons.parts(settings.n_splits, settings.batch_size)
    work = Path(params.work) / inputs_digest(dict(params.items()), files)
    table = run_batches(lambda name: parts[name](), list(parts), work, CONSISTENCY, snakemake.threads, shown())
    summary = summarise_consistency(table)
    write_table(table, snakemake.output.splits, CONSISTENCY)
    write_table(summary, snakemake.output.summary, CONSISTENCY_SUMMARY)
    remove_finished(work)
    for _, row in summary.iterrows():
        told = "%s, %s: median %.2f sigmas, sigmas to be multiplied by %.2f"
        log.info(told, row["noise_model"], row["comparison"], row["median_distance"], row["sigma_factor"])
