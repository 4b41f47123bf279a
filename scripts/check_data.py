"""Check every file of a data set against its sum, and note the sums."""

from pathlib import Path

import pandas as pd
from adapter import stage

with stage(snakemake) as log:
    from linepose.survey.datasets import check_dataset
    from linepose.tables import write_csv

    folder = Path(snakemake.params.folder)
    sums = check_dataset(folder, snakemake.params.sha256)
    write_csv(pd.DataFrame(sums.items(), columns=["file", "sha256"]), snakemake.output[0])
    log.info("%d files in %s", len(sums), folder)
