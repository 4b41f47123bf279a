"""Judge each chain, and put the poses with their sigmas into one table."""

from pathlib import Path

import numpy as np
from adapter import stage

with stage(snakemake) as log:
    from linepose.config.platform import Platform
    from linepose.estimation.diagnostics import diagnose_samples
    from linepose.pipeline.stages import (
        DIAGNOSTICS,
        OPTIMA,
        POSE,
        SAMPLES,
        diagnostics_table,
        estimated_parameters,
        pose_table,
        samples_from_table,
    )
    from linepose.tables import read_table, write_table

    platform = Platform.model_validate(snakemake.params.platform)
    optima = read_table(snakemake.input.optima, OPTIMA)
    names = estimated_parameters(optima)
    chains = {}
    for name in optima["stage"]:
        table = read_table(Path(snakemake.input.samples) / f"{name}.parquet", SAMPLES)
        chains[name] = diagnose_samples(samples_from_table(table, names))
    write_table(diagnostics_table(optima, chains), snakemake.output.diagnostics, DIAGNOSTICS)
    sigma = np.sqrt(np.diag(platform.start_covariance()))
    poses = pose_table(optima, {name: chain.sigma for name, chain in chains.items()}, platform.start_pose(), sigma)
    write_table(poses, snakemake.output.pose, POSE)
    for name in ("all", "inliers"):
        if chains[name].warning:
            log.warning("%s: %s", name, chains[name].warning)
