"""Write a platform's page, and its summary for the study's page."""

from pathlib import Path

from adapter import stage

with stage(snakemake) as log:
    from linepose.config.platform import Platform
    from linepose.output.report.assemble import platform_on_page
    from linepose.output.report.page import render_platform_page
    from linepose.output.report.provenance import settings_text, versions
    from linepose.output.report.summary_file import write_summary
    from linepose.pipeline.calibration import Calibration
    from linepose.tables import atomic_write

    study, output = snakemake.params.study, snakemake.output
    platform = Platform.model_validate(snakemake.params.platform)
    calibration = Calibration.from_results(Path(output.page).parent, platform, study["outliers"]["threshold_px"])
    one = platform_on_page(calibration, snakemake.params.platform)
    page = render_platform_page(one, settings_text(study), versions())
    with atomic_write(output.page) as path:
        path.write_text(page, encoding="utf-8")
    with atomic_write(output.summary) as path:
        write_summary(one.summary, path)
    log.info("%s: %s %.1f MB", calibration.name, one.summary.verdict.sentence, len(page.encode()) / 1e6)
