"""Sections of the configuration by the names that rules' parameters and results have for them."""

from collections.abc import Mapping
from typing import Any, Final

from linepose.config.project import Project
from linepose.pipeline.provenance import plain_settings

PLATFORM: Final = "platform"
OTHERS: Final = "others"
GROUPS: Final = {"sections", "study"}
_OF_NO_EFFECT: Final = {"description", "experiments", "outline", "map_frame", "map"}  # on what is calibrated


def platform_section(project: Project, platform: str) -> dict[str, Any]:
    """What a platform's file says of all that a calibration rests on."""
    return project.platforms[platform].model_dump(mode="json", exclude=_OF_NO_EFFECT)


def study_section(project: Project, name: str) -> Any:
    """What config.yaml says under a key."""
    return project.study.model_dump(mode="json")[name]


def present_section(project: Project, platform: str, name: str, recorded: Any, experiments: Mapping[str, Any]) -> Any:
    """What the configuration now has of a section that a result records; raises KeyError for an unknown name.

    A group of sections has those that are recorded. `experiments` are the sections of the platform's experiments.
    """
    if name == "sections":  # of experiments, whose keys may be those of config.yaml too
        return {key: plain_settings({key: experiments[key]})[key] for key in recorded}
    if name in GROUPS:
        return {key: present_section(project, platform, key, value, experiments) for key, value in recorded.items()}
    if name == PLATFORM:
        whole = project.platforms[platform].model_dump(mode="json")  # figures record more than a calibration does
        found: Any = {key: value for key, value in whole.items() if key in recorded or key not in _OF_NO_EFFECT}
    elif name == OTHERS:
        found = {other: platform_section(project, other) for other in recorded if other in project.platforms}
    elif name in type(project.study).model_fields:
        found = study_section(project, name)
    elif name in experiments:
        found = experiments[name]
    else:
        found = platform_section(project, platform)[name]
    return plain_settings({name: found})[name]
