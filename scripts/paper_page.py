"""Write the page of published and obtained numbers."""

from pathlib import Path

from adapter import stage

with stage(snakemake) as log:
    from linepose.paper.page import render_paper_page
    from linepose.paper.regression import REGRESSION
    from linepose.paper.report_sections import published_sections
    from linepose.tables import atomic_write, read_table

    tables = {Path(path).stem: read_table(path) for path in snakemake.input.tables}
    sections = published_sections(read_table(snakemake.input.regression, REGRESSION), tables)
    page = render_paper_page(sections, snakemake.params.left_out)
    with atomic_write(snakemake.output[0]) as path:
        path.write_text(page, encoding="utf-8")
    log.info("%s: %.1f MB", snakemake.output[0], len(page.encode()) / 1e6)
