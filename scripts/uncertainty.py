"""Put sampled and Laplace sigmas of each outlier stage side by side."""

from adapter import stage

with stage(snakemake):
    from linepose.experiments.schemas import UNCERTAINTY
    from linepose.experiments.uncertainty import uncertainty_by_stage
    from linepose.pipeline.result_schemas import OPTIMA, POSE
    from linepose.tables import read_table, write_table

    optima, poses = read_table(snakemake.input.optima, OPTIMA), read_table(snakemake.input.poses, POSE)
    write_table(uncertainty_by_stage(optima, poses), snakemake.output[0], UNCERTAINTY)
