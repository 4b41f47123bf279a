"""Hold the results against the published numbers."""

from dataclasses import replace
from pathlib import Path

import pandas as pd
from adapter import stage

with stage(snakemake) as log:
    from linepose.config.platform import read_yaml
    from linepose.result_schemas import NAVIGATION_SIGMA, OUTLIERS, POSE, REGRESSION, TRUTH_ERROR
    from linepose.storage import read_table, write_csv, write_table
    from linepose.tables.regression import PlatformResults, regression_table

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
    table = regression_table(read_yaml(Path(snakemake.input.published)), results, published_as)
    write_table(table, snakemake.output.parquet, REGRESSION)
    write_csv(table, snakemake.output.csv)
    known = int((table["known_deviation"] & ~table["passed"]).sum())
    log.info("%d of %d published numbers reproduced, %d known deviations", table["passed"].sum(), len(table), known)
