"""Download a data set and check its files."""

from pathlib import Path

from adapter import stage

with stage(snakemake) as log:
    from linepose.config.study import load_dataset
    from linepose.survey.datasets import download_dataset

    dataset = load_dataset(Path(snakemake.input.sums))
    name = snakemake.params.dataset
    searched = [Path(place) for place in snakemake.params.searched]
    folder = searched[0] / name
    download_dataset(name, dataset.base_url, dataset.sha256, dataset.urls, folder, searched)
    log.info("%d files in %s", len(dataset.sha256), folder)
