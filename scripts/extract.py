"""Find the pattern points of a platform's observations: labelled views, or scans."""

from pathlib import Path

from adapter import stage

with stage(snakemake) as log:
    from linepose.config.platform import Platform
    from linepose.inputs.labels.labelled_views import POINTS
    from linepose.inputs.observed_points import SCAN_POINTS
    from linepose.inputs.source import LabelledViewsSection
    from linepose.pipeline.load import measurements_in_words, read_points
    from linepose.tables import write_table

    platform = Platform.model_validate(snakemake.params.platform)
    folder = Path(snakemake.params.folder)
    points = read_points(platform, folder)
    schema = POINTS if isinstance(platform.source, LabelledViewsSection) else SCAN_POINTS
    write_table(points, snakemake.output[0], schema)
    log.info("%s of %s", measurements_in_words(points), folder)
