"""Read the labelled points of a platform's views."""

from pathlib import Path

from adapter import stage

with stage(snakemake) as log:
    from linepose.config.platform import Platform
    from linepose.extraction.labelled_views import read_labelled_views, select_views
    from linepose.result_schemas import POINTS
    from linepose.storage import write_table

    platform = Platform.model_validate(snakemake.params.platform)
    folder = Path(snakemake.params.folder)
    source = platform.source
    views = select_views(folder, source.views, source.first, source.step)
    points = read_labelled_views(views, platform.camera.n_pixels)
    write_table(points, snakemake.output[0], POINTS)
    log.info("%d points in %d views of %s", len(points), len(views), folder)
