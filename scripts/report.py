"""Write the report of all platforms."""

from pathlib import Path

from adapter import stage

with stage(snakemake) as log:
    from linepose.config.platform import Platform
    from linepose.figures.results import PlatformResults
    from linepose.report.made_with import settings_text, versions
    from linepose.report.page import PlatformOnPage, figures_on_page, render_page
    from linepose.report.platform_sections import platform_sections
    from linepose.report.published import published_sections
    from linepose.report.summary import summarise
    from linepose.result_schemas import FIGURES, REGRESSION
    from linepose.storage import read_table, whole_file

    platforms = []
    for name, values in snakemake.params.platforms.items():
        folder = Path(snakemake.output[0]).parent / name
        platform = Platform.model_validate(values)
        results = PlatformResults(name, platform, folder, snakemake.params.study["outliers"]["threshold_px"])
        figures = figures_on_page(name, folder / "figures", read_table(folder / "figures" / "index.parquet", FIGURES))
        platforms.append(PlatformOnPage(summarise(results), platform_sections(results), figures, settings_text(values)))
        log.info("%s: %s", name, platforms[-1].summary.verdict.sentence)
    page = render_page(
        platforms,
        published_sections(
            read_table(snakemake.input.regression, REGRESSION),
            {Path(path).stem: read_table(path) for path in snakemake.input.tables},
        ),
        settings_text(snakemake.params.study),
        versions(),
    )
    with whole_file(snakemake.output[0]) as path:
        path.write_text(page, encoding="utf-8")
    log.info("%s: %.1f MB", snakemake.output[0], len(page.encode()) / 1e6)
