"""Find the pattern points of a platform's observations: labelled views, or scans."""

from pathlib import Path

from adapter import stage

with stage(snakemake) as log:
    from linepose.config.platform import LabelledViewsSection, Platform
    from linepose.extraction.labelled_views import read_labelled_views, select_views
    from linepose.extraction.refine import METHODS
    from linepose.extraction.scan_survey import detected_points, refined_points, select_scans
    from linepose.formats.labels import read_point_labels
    from linepose.formats.line_times import line_times_of
    from linepose.result_schemas import POINTS, SCAN_POINTS
    from linepose.storage import write_table

    platform = Platform.model_validate(snakemake.params.platform)
    folder = Path(snakemake.params.folder)
    source, n_pixels = platform.source, platform.camera.n_pixels
    if isinstance(source, LabelledViewsSection):
        views = select_views(folder, source.views, source.first, source.step)
        points, schema = read_labelled_views(views, n_pixels), POINTS
    else:
        scans, refine = select_scans(folder, source.scans, source.left_out), METHODS[source.refinement]
        line_times, schema = line_times_of(source), SCAN_POINTS
        if source.points == "detection":
            points = detected_points(scans, refine, n_pixels, line_times)
        else:
            labels = read_point_labels(folder, source.labels, scans, n_pixels)
            points = refined_points(scans, labels, refine, n_pixels, line_times)
    write_table(points, snakemake.output[0], schema)
    log.info("%d points in %d views of %s", len(points), points["observation"].nunique(), folder)
