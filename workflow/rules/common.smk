from pathlib import Path

from snakemake.exceptions import WorkflowError

from linepose.config.study import check_study, load_dataset, load_platforms
from linepose.datasets import find_dataset
from linepose.errors import LineposeError
from linepose.provenance import source_digest

try:
    STUDY = check_study(config)
    PLATFORMS = load_platforms(STUDY, Path())
    DATASETS = {name: load_dataset(Path(sums)) for name, sums in STUDY.datasets.items()}
    FOLDERS = {
        name: find_dataset(
            name, list(dataset.sha256), [Path(folder) for folder in STUDY.data_folders]
        )
        or Path(STUDY.data_folders[0]) / name
        for name, dataset in DATASETS.items()
    }
    for name, platform in PLATFORMS.items():
        if platform.source.dataset not in DATASETS:
            raise LineposeError(
                f"platform {name}: source.dataset: found {platform.source.dataset!r}, "
                f"expected one of {sorted(DATASETS)}; add it to datasets in config/config.yaml"
            )
except LineposeError as error:
    raise WorkflowError(str(error)) from None


wildcard_constraints:
    platform="[A-Za-z0-9_-]+",


def settings(wildcards):
    """What the platform's file says, as a rule's parameter: a change of it runs the rule again."""
    return PLATFORMS[wildcards.platform].model_dump(
        mode="json", exclude={"description", "published"}
    )


def section(name):
    """What config.yaml says under this key, as a rule's parameter."""
    return getattr(STUDY, name).model_dump(mode="json")


def dataset_files(wildcards):
    """Every file of the platform's data set, where it was found or will be downloaded to."""
    name = PLATFORMS[wildcards.platform].source.dataset
    return [FOLDERS[name] / file for file in DATASETS[name].sha256]
