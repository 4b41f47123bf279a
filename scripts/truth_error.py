"""Hold the estimate of a simulated platform against the truth."""

from pathlib import Path

import pandas as pd
from adapter import stage

with stage(snakemake) as log:
    from linepose.experiments.truth_error import flat_samples, true_pose, truth_error_table
    from linepose.pipeline.result_schemas import OPTIMA, SAMPLES, TRUTH_ERROR
    from linepose.tables import read_table, write_table

    optima = read_table(snakemake.input.optima, OPTIMA)
    folder = Path(snakemake.input.samples)
    samples = {name: flat_samples(read_table(folder / f"{name}.parquet", SAMPLES)) for name in optima["stage"]}
    truth = pd.read_parquet(snakemake.input.truth)
    table = truth_error_table(optima, samples, true_pose(truth))
    write_table(table, snakemake.output[0], TRUTH_ERROR)
    whole = table[(table["stage"] == "inliers") & (table["quantity"] == "pose")].iloc[0]
    log.info("inliers: Mahalanobis distance to the truth %.2f", whole["error_in_sigmas"])
