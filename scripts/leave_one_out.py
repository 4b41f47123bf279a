"""Estimate the pose without each observation in turn."""

from adapter import stage

with stage(snakemake) as log:
    from linepose.config.platform import Platform
    from linepose.estimation.optimise import Search
    from linepose.experiments.accepted import read_accepted, read_reference
    from linepose.experiments.repeatability import leave_one_out
    from linepose.experiments.schemas import LEAVE_ONE_OUT
    from linepose.tables import write_table

    platform = Platform.model_validate(snakemake.params.platform)
    search = Search.model_validate(snakemake.params.search)
    data = read_accepted(platform, snakemake.input.observations, snakemake.input.outliers)
    reference = read_reference(data.accepted, snakemake.input.optima, snakemake.input.samples)
    table = leave_one_out(data.accepted, reference.pose, reference.covariance, search)
    write_table(table, snakemake.output[0], LEAVE_ONE_OUT)
    worst = table.loc[table["influence"].idxmax()]
    log.info("most influential: observation %d, %.2f sigmas", worst["left_out"], worst["influence"])
