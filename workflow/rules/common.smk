from pathlib import Path

from snakemake.exceptions import WorkflowError

from linepose.config.project import load_project
from linepose.errors import LineposeError
from linepose.provenance import source_digest

try:
    PROJECT = load_project(config, Path())
except LineposeError as error:
    raise WorkflowError(str(error)) from None

STUDY = PROJECT.study
PLATFORMS = list(PROJECT.platforms)


wildcard_constraints:
    platform="[A-Za-z0-9_-]+",


def settings(wildcards):
    """What the platform's file says, as a rule's parameter: a change of it runs the rule again."""
    return PROJECT.platforms[wildcards.platform].model_dump(
        mode="json", exclude={"description", "published", "outline"}
    )


def section(key):
    """What config.yaml says under this key, as a rule's parameter."""
    return getattr(STUDY, key).model_dump(mode="json")
