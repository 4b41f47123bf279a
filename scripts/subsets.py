"""Estimate the pose from each subset that the platform names."""

from adapter import stage

with stage(snakemake) as log:
    from linepose.config.experiments import SubsetSection
    from linepose.config.platform import Platform
    from linepose.config.study import sampling_settings
    from linepose.estimation.optimise import Search
    from linepose.experiments.accepted import read_accepted
    from linepose.experiments.schemas import SUBSETS
    from linepose.experiments.subsets import subset_estimates
    from linepose.tables import write_table

    platform = Platform.model_validate(snakemake.params.platform)
    sections = {key: SubsetSection.model_validate(value) for key, value in snakemake.params.subsets.items()}
    search = Search.model_validate(snakemake.params.search)
    sampling = sampling_settings(snakemake.params.sampling)
    data = read_accepted(platform, snakemake.input.observations, snakemake.input.outliers)
    subsets = data.subsets(sections, f"{snakemake.params.file}: experiments.subsets")
    table = subset_estimates(data.accepted, subsets, platform.start_pose(), snakemake.params.seed, search, sampling)
    write_table(table, snakemake.output[0], SUBSETS)
    for _, row in table.iterrows():
        log.info("%s: observations %s, -log L %.6f", row["subset"], row["observations"], row["neg_log_likelihood"])
