"""Hold the results against the published numbers."""

from dataclasses import replace
from pathlib import Path

import pandas as pd
from adapter import stage

with stage(snakemake) as log:
    from linepose.config.platform import read_yaml
    from linepose.estimation.outliers import OUTLIERS
    from linepose.experiments.basin import BASIN_SUMMARY
    from linepose.experiments.repeatability import REPEATABILITY
    from linepose.experiments.subsets import SUBSETS
    from linepose.experiments.truth_error import TRUTH_ERROR
    from linepose.inputs.targets.measured import DETECTION, EXTRACTION_ACCURACY
    from linepose.paper.experiments_regression import BASIN_ROWS_OF, table_rows
    from linepose.paper.regression import PlatformResults, regression_table
    from linepose.paper.row import REGRESSION
    from linepose.paper.simulated_regression import extraction_rows
    from linepose.pipeline.stages import POSE
    from linepose.survey.navigation import NAVIGATION_SIGMA
    from linepose.tables import read_table, write_csv, write_table

    published_as = snakemake.params.published_as
    files = zip(published_as, snakemake.input.pose, snakemake.input.outliers, snakemake.input.sigma, strict=True)
    results = {
        name: PlatformResults(
            read_table(pose, POSE), read_table(outliers, OUTLIERS), read_table(sigma, NAVIGATION_SIGMA)
        )
        for name, pose, outliers, sigma in files
    }
    known_truth = zip(snakemake.params.on_truth, snakemake.input.truth, snakemake.input.truth_error, strict=True)
    for name, truth, error in known_truth:
        results[name] = replace(results[name], truth=pd.read_parquet(truth), truth_error=read_table(error, TRUTH_ERROR))
    published = read_yaml(Path(snakemake.input.published))
    rows = []
    for name, subsets, pairs in zip(
        snakemake.params.compared, snakemake.input.subsets, snakemake.input.pairs, strict=True
    ):
        rows += table_rows(name, published, read_table(subsets, SUBSETS), read_table(pairs, REPEATABILITY))
    for name, summary in zip(snakemake.params.swept, snakemake.input.basin, strict=True):
        rows += BASIN_ROWS_OF[published_as[name]](name, published, read_table(summary, BASIN_SUMMARY))
    measured = zip(snakemake.params.on_truth.items(), snakemake.input.accuracy, snakemake.input.detection, strict=True)
    for (name, sigma_px), accuracy, detection in measured:
        rows += extraction_rows(
            name, read_table(accuracy, EXTRACTION_ACCURACY), read_table(detection, DETECTION), sigma_px
        )
    stages = regression_table(published, results, published_as)
    table = pd.concat([stages, pd.DataFrame(rows, columns=stages.columns)], ignore_index=True)
    write_table(table, snakemake.output.parquet, REGRESSION)
    write_csv(table, snakemake.output.csv)
    known = int((table["known_deviation"] & ~table["passed"]).sum())
    log.info("%d of %d published numbers reproduced, %d known deviations", table["passed"].sum(), len(table), known)
