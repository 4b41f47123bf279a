"""Tell of each parameter whether data or prior decided it."""

from pathlib import Path

import numpy as np
from adapter import stage

with stage(snakemake) as log:
    from linepose.config.platform import Platform
    from linepose.experiments.accepted import read_accepted, read_reference
    from linepose.experiments.prior import prior_table
    from linepose.experiments.schemas import PRIOR
    from linepose.pipeline.result_schemas import SAMPLES
    from linepose.tables import read_table, write_table

    platform = Platform.model_validate(snakemake.params.platform)
    likelihood = read_accepted(platform, snakemake.input.observations, snakemake.input.outliers).accepted
    optimum = read_reference(likelihood, snakemake.input.optima, snakemake.input.samples).parameters
    names = likelihood.parameter_names
    samples = read_table(Path(snakemake.input.samples) / "inliers.parquet", SAMPLES)[list(names)]
    priors, counted_in = likelihood.parameter_priors(), platform.pose_prior() is not None
    table = prior_table(names, optimum, np.cov(samples.to_numpy().T), platform.hand_measurement(), priors, counted_in)
    write_table(table, snakemake.output[0], PRIOR)
    for _, row in table.iterrows():
        log.info("%s: decided by %s, weight of the data %.2f", row["parameter"], row["decided_by"], row["data_weight"])
