"""Give each point the body pose, where it has none yet, and the navigation covariance of nearest time stamp."""

from pathlib import Path

from adapter import stage

with stage(snakemake) as log:
    from linepose.config.platform import Platform
    from linepose.inputs.labels.labelled_views import POINTS
    from linepose.inputs.local_frame import MAP_FRAME
    from linepose.inputs.observed_points import SCAN_POINTS
    from linepose.inputs.source import LabelledViewsSection
    from linepose.pipeline.load import read_reported, with_navigation
    from linepose.pipeline.survey_frame import map_frame_table
    from linepose.survey.navigation import NAVIGATION_SIGMA, median_sigma_table
    from linepose.survey.observations import OBSERVATIONS
    from linepose.tables import read_table, write_table

    platform, folder = Platform.model_validate(snakemake.params.platform), Path(snakemake.params.folder)
    schema = POINTS if isinstance(platform.source, LabelledViewsSection) else SCAN_POINTS
    observations = with_navigation(read_table(snakemake.input[0], schema), platform, folder)
    write_table(observations, snakemake.output.observations, OBSERVATIONS)
    write_table(median_sigma_table(read_reported(platform, folder)), snakemake.output.sigma, NAVIGATION_SIGMA)
    write_table(map_frame_table(platform, folder), snakemake.output.frame, MAP_FRAME)
    log.info("largest gap to a covariance: %.3f s", observations["nav_gap_s"].max())
