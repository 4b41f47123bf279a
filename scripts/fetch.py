"""Download a data set and check its files."""

from pathlib import Path

from adapter import stage
from snakemake.script import snakemake

with stage(snakemake) as log:
    from linepose.config.study import load_dataset
    from linepose.datasets import download_dataset

    dataset = load_dataset(Path(snakemake.input.sums))
    folder = Path(snakemake.params.folder)
    searched = [Path(place) for place in snakemake.params.searched]
    download_dataset(folder.name, dataset.base_url, dataset.sha256, dataset.urls, folder, searched)
    log.info("%d files in %s", len(dataset.sha256), folder)
