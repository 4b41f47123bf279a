from pathlib import Path

from snakemake.exceptions import WorkflowError

from linepose.config.project import load_project
from linepose.errors import LineposeError
from linepose.provenance import files_digest, source_digest

try:
    PROJECT = load_project(config, Path())
except LineposeError as error:
    raise WorkflowError(str(error)) from None

STUDY = PROJECT.study
PLATFORMS = STUDY.platforms


wildcard_constraints:
    platform="[A-Za-z0-9_-]+",


def settings(wildcards):
    """What the platform's file says, as a rule's parameter: a change of it runs the rule again."""
    return PROJECT.platforms[wildcards.platform].model_dump(
        mode="json",
        exclude={"description", "published", "experiments", "outline"},
    )


def experiment(key):
    """What the platform's file says of one experiment, as a rule's parameter."""
    return lambda wildcards: PROJECT.platforms[
        wildcards.platform
    ].experiments.model_dump(mode="json")[key]


def platform_file(wildcards):
    """The platform's file, for messages."""
    return f"{STUDY.platforms_folder}/{wildcards.platform}.yaml"


def section(key):
    """What config.yaml says under this key, as a rule's parameter."""
    return getattr(STUDY, key).model_dump(mode="json")
