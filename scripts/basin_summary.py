"""Count the successes inside and outside of the region that is claimed."""

import pandas as pd
from adapter import stage

with stage(snakemake) as log:
    from linepose.config.experiments import BasinSection
    from linepose.experiments.basin import summarise
    from linepose.experiments.schemas import BASIN, BASIN_SUMMARY
    from linepose.tables import read_table, write_table

    region = BasinSection.model_validate(snakemake.params.basin).region()
    sweep = read_table(snakemake.input[0], BASIN)
    parts = [summarise(rows, region).assign(optimiser=name) for name, rows in sweep.groupby("optimiser", sort=False)]
    table = pd.concat(parts, ignore_index=True)
    write_table(table, snakemake.output[0], BASIN_SUMMARY)
    for _, row in table.iterrows():
        log.info("%s, %s: %.1f %%", row["optimiser"], row["region"], 100 * row["success_rate"])
