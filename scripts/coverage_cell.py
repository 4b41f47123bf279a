"""Put a cell's shares of surveys together."""

import pandas as pd
from adapter import stage

with stage(snakemake) as log:
    from linepose.experiments.coverage import COVERAGE_SURVEYS
    from linepose.tables import read_table, write_table

    parts = [read_table(part, COVERAGE_SURVEYS) for part in snakemake.input.parts]
    table = pd.concat([part for part in parts if not part.empty], ignore_index=True)
    write_table(table, snakemake.output[0], COVERAGE_SURVEYS)
    held = [(table["credibility"] < nominal).mean() for nominal in (0.68, 0.95)]
    log.info("%d surveys: 68 %% holds the truth in %.2f, 95 %% in %.2f", len(table), *held)
