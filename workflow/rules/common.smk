import os
from pathlib import Path

from snakemake.exceptions import WorkflowError
from snakemake.logging import logger

from linepose.config.project import load_project
from linepose.survey.datasets import can_be_reached
from linepose.errors import LineposeError
from linepose.estimation.noise_models import NOISE_MODELS
from linepose.pipeline import code_digest
from linepose.tables import read_table


def can_download(dataset):
    """Whether the data set's server answers; asked once, because every job of a run reads this file anew."""
    key = f"LINEPOSE_REACHED_{dataset.base_url}"
    if key not in os.environ:
        os.environ[key] = str(
            int(can_be_reached(dataset.address(next(iter(dataset.sha256)))))
        )
    return os.environ[key] == "1"


try:
    PROJECT = load_project(config, Path(), can_download)
except LineposeError as error:
    raise WorkflowError(str(error)) from None

if PROJECT.unavailable and workflow.is_main_process:
    logger.warning(
        f"data set {', '.join(PROJECT.unavailable)}: not in {', '.join(PROJECT.study.data_folders)} and not to be "
        f"downloaded; only the other platforms run: {', '.join(PROJECT.platforms)}"
    )

STUDY = PROJECT.study
PLATFORMS = [name for name in STUDY.platforms if name in PROJECT.platforms]
PAPER_RESULTS = []  # what `rule all` makes of the paper, where config/paper exists
FURTHER_PAGES = {}  # that the report links to: title and address


wildcard_constraints:
    platform="[A-Za-z0-9_-]+",


def settings(wildcards):
    """What the platform's file says, as a rule's parameter: a change of it runs the rule again."""
    return PROJECT.platforms[wildcards.platform].model_dump(
        mode="json",
        exclude={"description", "experiments", "outline", "map_frame"},
    )


def experiment(key):
    """What the platform's file says of one experiment, as a rule's parameter."""
    return lambda wildcards: PROJECT.platforms[
        wildcards.platform
    ].experiments.model_dump(mode="json")[key]


def readable(wildcards):
    """The check of what the platform recorded; what was simulated here needs none."""
    if wildcards.platform in PROJECT.simulated:
        return []
    return f"results/logs/{wildcards.platform}/check_readable.passed"


def compiled(wildcards):
    """The compiled kernel of the platform's noise model; the others may still be in the making."""
    return f"results/compiled/{PROJECT.platforms[wildcards.platform].noise_model}.txt"


def platform_file(wildcards):
    """The platform's file, for messages."""
    return f"{STUDY.platforms_folder}/{wildcards.platform}.yaml"


def sampling(wildcards):
    """How the platform's noise model is sampled, as a rule's parameter."""
    noise_model = PROJECT.platforms[wildcards.platform].noise_model
    return STUDY.sampling_of(noise_model).model_dump(mode="json")


def section(key):
    """What config.yaml says under this key, as a rule's parameter."""
    return getattr(STUDY, key).model_dump(mode="json")


def script_digest(name, *modules):
    """Digest of a script's code, and of modules that it imports by name, as the rule's parameter `code`."""
    script = workflow.source_path(f"../../scripts/{name}.py")
    return code_digest.script_digest(script, *modules)
