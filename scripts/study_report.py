"""Write the study's page over all platforms that have results, those of this run and those of earlier ones."""

from pathlib import Path

from adapter import stage

with stage(snakemake) as log:
    from linepose.output.report.page import render_study_page, worst_first
    from linepose.output.report.provenance import settings_text, versions
    from linepose.output.report.summary_file import read_summary, summaries_on_disk
    from linepose.tables import atomic_write

    made = {Path(path).parent.name: Path(path) for path in snakemake.input}
    others = summaries_on_disk(Path(snakemake.output[0]).parent)
    summaries = [read_summary(path) for path in (others | made).values()]
    page = render_study_page(
        worst_first(summaries),
        settings_text(snakemake.params.study),
        versions(),
        snakemake.params.further_pages,
    )
    with atomic_write(snakemake.output[0]) as path:
        path.write_text(page, encoding="utf-8")
    log.info("%d platforms", len(summaries))
