"""Compare the poses of two disjoint subsets."""

from adapter import stage

with stage(snakemake) as log:
    from linepose.config.experiments import RepeatabilitySection
    from linepose.config.platform import Platform
    from linepose.config.study import sampling_settings
    from linepose.estimation.optimise import Search
    from linepose.experiments.accepted import read_accepted
    from linepose.experiments.repeatability import compare_subsets
    from linepose.experiments.schemas import REPEATABILITY
    from linepose.tables import write_table

    platform = Platform.model_validate(snakemake.params.platform)
    settings = RepeatabilitySection.model_validate(snakemake.params.repeatability)
    search = Search.model_validate(snakemake.params.search)
    sampling = sampling_settings(snakemake.params.sampling)
    data = read_accepted(platform, snakemake.input.observations, snakemake.input.outliers)
    pair = {"subset_1": settings.first, "subset_2": settings.second}
    place = f"{snakemake.params.file}: experiments.repeatability"
    subsets = data.subsets(pair, place)
    seed = snakemake.params.seed
    table = compare_subsets(data.accepted, subsets, platform.start_pose(), seed, place, search, sampling)
    write_table(table, snakemake.output[0], REPEATABILITY)
    log.info("%.2f sigmas apart, p = %.2f", table["mahalanobis"].iloc[0], table["p_value"].iloc[0])
