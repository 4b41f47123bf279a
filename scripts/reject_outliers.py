"""Remove the worst observation again and again, and note which stage is accepted."""

from functools import partial
from pathlib import Path

from adapter import stage

with stage(snakemake) as log:
    from linepose.config.platform import Platform
    from linepose.estimation.optimise import Search
    from linepose.estimation.outliers import OUTLIERS, OutlierSettings, outlier_table, reject_outliers, removal_order
    from linepose.pipeline.observation_files import observation_in_words
    from linepose.pipeline.platform_estimator import platform_likelihood
    from linepose.survey.observations import OBSERVATIONS, survey_from_table
    from linepose.tables import read_table, write_table

    platform = Platform.model_validate(snakemake.params.platform)
    outliers = OutlierSettings.model_validate(snakemake.params.outliers)
    search = Search.model_validate(snakemake.params.search)
    survey = survey_from_table(read_table(snakemake.input.observations, OBSERVATIONS))
    likelihood = platform_likelihood(platform, survey)
    stages = reject_outliers(likelihood, platform.start_pose(), outliers.minimum_observations, search)
    sums = Path(f"results/datasets/{platform.source.dataset}.csv")
    table = outlier_table(stages, outliers.threshold_px, partial(observation_in_words, platform, sums))
    write_table(table, snakemake.output[0], OUTLIERS)
    log.info("removed in this order: %s", ", ".join(map(str, removal_order(table))) or "none")
