"""Give each point the body pose, where it has none yet, and the navigation covariance of nearest time stamp."""

from pathlib import Path

from adapter import stage

with stage(snakemake) as log:
    from linepose.config.platform import Platform, ScansSection
    from linepose.formats.navigation import log_covariances, read_navigation
    from linepose.navigation import associate_covariances, median_sigma_table, read_covariances
    from linepose.navigation_log import POSE_AT, associate_poses
    from linepose.observations import check_determined, survey_from_table
    from linepose.pose import N_PARAMETERS
    from linepose.result_schemas import NAVIGATION_SIGMA, OBSERVATIONS, POINTS, SCAN_POINTS
    from linepose.storage import read_table, write_table

    platform = Platform.model_validate(snakemake.params.platform)
    navigation, source, folder = platform.navigation, platform.source, Path(snakemake.params.folder)
    if isinstance(source, ScansSection):
        record = read_navigation(source, folder)
        covariances = log_covariances(record, source, navigation.covariance_columns, folder)
        points = read_table(snakemake.input[0], SCAN_POINTS).drop(columns="line")
        points = associate_poses(points, record.log, POSE_AT[navigation.association], navigation.maximum_pose_gap_s)
    else:
        points = read_table(snakemake.input[0], POINTS)
        covariances = read_covariances(folder / source.covariances, navigation.covariance_columns)
    observations = associate_covariances(points, covariances, navigation.maximum_gap_s)
    check_determined(survey_from_table(observations), N_PARAMETERS, str(folder))
    write_table(observations, snakemake.output.observations, OBSERVATIONS)
    write_table(median_sigma_table(covariances), snakemake.output.sigma, NAVIGATION_SIGMA)
    log.info("largest gap to a covariance: %.3f s", observations["nav_gap_s"].max())
