"""Put the cells of the coverage study together: tables and figures."""

from pathlib import Path

import pandas as pd
from adapter import stage

with stage(snakemake) as log:
    from linepose.experiments.coverage import COVERAGE_SURVEYS
    from linepose.experiments.coverage_summary import (
        COVERAGE,
        COVERAGE_SUMMARY,
        coverage_curve,
        coverage_summary,
        stated_probabilities,
    )
    from linepose.experiments.coverage_table import coverage_table
    from linepose.output.figures import coverage as figures
    from linepose.output.figures.style import save
    from linepose.pipeline.file_list import write_file_list
    from linepose.tables import atomic_write, read_table, write_csv, write_table

    cells = [read_table(path, COVERAGE_SURVEYS) for path in snakemake.input.cells]
    surveys = pd.concat([cell.astype(cells[0].dtypes) for cell in cells], ignore_index=True)
    curve, summary = coverage_curve(surveys, stated_probabilities()), coverage_summary(surveys, snakemake.params.pools)
    write_table(surveys, snakemake.output.surveys, COVERAGE_SURVEYS)
    write_table(curve, snakemake.output.coverage, COVERAGE)
    write_table(summary, snakemake.output.summary, COVERAGE_SUMMARY)
    write_csv(summary, snakemake.output.csv)
    with atomic_write(snakemake.output.table) as path:
        path.write_text(coverage_table(summary), encoding="utf-8")
    folder = Path(snakemake.output.figures)
    save(figures.coverage(curve), folder / "coverage")
    save(figures.ratios(summary), folder / "ratios")
    save(figures.errors(summary), folder / "errors")
    write_file_list(folder, Path(snakemake.output.files))
    log.info("%d surveys in %d cells", len(surveys), len(summary))
