"""Give each point the navigation covariance of nearest time stamp."""

from pathlib import Path

from adapter import stage

with stage(snakemake) as log:
    from linepose.config.platform import Platform
    from linepose.navigation import associate_covariances, median_sigma_table, read_covariances
    from linepose.observations import check_determined, survey_from_table
    from linepose.pose import N_PARAMETERS
    from linepose.result_schemas import NAVIGATION_SIGMA, OBSERVATIONS, POINTS
    from linepose.storage import read_table, write_table

    platform = Platform.model_validate(snakemake.params.platform)
    navigation = platform.navigation
    path = Path(snakemake.params.folder) / platform.source.covariances
    covariances = read_covariances(path, navigation.covariance_columns)
    points = read_table(snakemake.input[0], POINTS)
    observations = associate_covariances(points, covariances, navigation.maximum_gap_s)
    check_determined(survey_from_table(observations), N_PARAMETERS)
    write_table(observations, snakemake.output.observations, OBSERVATIONS)
    write_table(median_sigma_table(covariances), snakemake.output.sigma, NAVIGATION_SIGMA)
    log.info("largest gap to a covariance: %.3f s", observations["nav_gap_s"].max())
