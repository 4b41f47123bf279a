"""Write the report of all platforms."""

from pathlib import Path

from adapter import stage

with stage(snakemake) as log:
    from linepose.config.platform import Platform
    from linepose.output.report.assemble import platform_on_page
    from linepose.output.report.page import render_page
    from linepose.output.report.provenance import settings_text, versions
    from linepose.pipeline.calibration import Calibration
    from linepose.tables import atomic_write

    platforms = []
    for name, values in snakemake.params.platforms.items():
        calibration = Calibration.from_results(
            Path(snakemake.output[0]).parent / name,
            Platform.model_validate(values),
            snakemake.params.study["outliers"]["threshold_px"],
        )
        platforms.append(platform_on_page(calibration, values))
        log.info("%s: %s", name, platforms[-1].summary.verdict.sentence)
    page = render_page(
        platforms,
        settings_text(snakemake.params.study),
        versions(),
        snakemake.params.further_pages,
    )
    with atomic_write(snakemake.output[0]) as path:
        path.write_text(page, encoding="utf-8")
    log.info("%s: %.1f MB", snakemake.output[0], len(page.encode()) / 1e6)
