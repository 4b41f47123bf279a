"""Write the report of all platforms."""

from pathlib import Path

from adapter import stage

with stage(snakemake) as log:
    from linepose.config.platform import Platform
    from linepose.figures.results import PlatformResults
    from linepose.report.page import (
        PlatformOnPage,
        figures_on_page,
        regression_on_page,
        render_page,
        settings_text,
        table_on_page,
        versions,
    )
    from linepose.report.summary import summarise
    from linepose.result_schemas import FIGURES, REGRESSION
    from linepose.storage import read_table, whole_file

    platforms = []
    for name, values in snakemake.params.platforms.items():
        folder = Path(snakemake.output[0]).parent / name
        platform = Platform.model_validate(values)
        results = PlatformResults(name, platform, folder, snakemake.params.study["outliers"]["threshold_px"])
        index = read_table(folder / "figures" / "index.parquet", FIGURES)
        figures = figures_on_page(name, folder / "figures", index)
        platforms.append(PlatformOnPage(summarise(results), figures, settings_text(values)))
        log.info("%s: %s", name, platforms[-1].summary.verdict.sentence)
    page = render_page(
        platforms,
        regression_on_page(read_table(snakemake.input.regression, REGRESSION)),
        [table_on_page(Path(path).stem, read_table(path)) for path in snakemake.input.tables],
        settings_text(snakemake.params.study),
        versions(),
    )
    with whole_file(snakemake.output[0]) as path:
        path.write_text(page, encoding="utf-8")
    log.info("%s: %.1f MB", snakemake.output[0], len(page.encode()) / 1e6)
