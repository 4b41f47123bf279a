"""Every experiment, one entry each; what a platform's file says of them, checked."""

from collections.abc import Mapping
from typing import Any, Final

from linepose.config.platform import Platform
from linepose.errors import InputError
from linepose.estimation.noise_models import noise_model
from linepose.experiments import (
    adjustment_beside,
    basin,
    clock_offset,
    leave_one_out,
    mapping,
    prior,
    repeatability,
    sensitivity,
    splits,
    subsets,
    truth_error,
    uncertainty,
)
from linepose.experiments.experiment import Experiment
from linepose.experiments.section import Section, settings_class
from linepose.settings import faults_of, validated

EXPERIMENTS: Final[tuple[Experiment, ...]] = (
    uncertainty.EXPERIMENT,
    prior.EXPERIMENT,
    subsets.EXPERIMENT,
    repeatability.EXPERIMENT,
    splits.EXPERIMENT,
    leave_one_out.EXPERIMENT,
    basin.EXPERIMENT,
    mapping.EXPERIMENT,
    sensitivity.EXPERIMENT,
    adjustment_beside.EXPERIMENT,
    clock_offset.EXPERIMENT,
    truth_error.EXPERIMENT,
)

SECTIONS: Final[Mapping[str, Section[Any]]] = {
    section.key: section for experiment in EXPERIMENTS for section in experiment.sections
}

# What a platform's file may say below `experiments`.
ExperimentsSettings = settings_class("ExperimentsSettings", {key: one.field for key, one in SECTIONS.items()})
_File = settings_class("PlatformFile", {"experiments": (ExperimentsSettings, ExperimentsSettings())})


def experiment(name: str) -> Experiment:
    """The experiment of a name; raises InputError for a name that none has."""
    for one in EXPERIMENTS:
        if one.name == name:
            return one
    raise InputError("experiment", name, f"one of {', '.join(one.name for one in EXPERIMENTS)}", "correct the name")


def wanted_experiments(platform: Platform) -> list[Experiment]:
    """The experiments that are run for a platform."""
    return [one for one in EXPERIMENTS if one.is_wanted(platform)]


def experiment_settings(platform: Platform, file: str = "platform") -> Any:
    """What a platform's file says of its experiments, an attribute a key; raises InputError for the first fault."""
    return validated(_File, {"experiments": platform.experiments}, file).experiments  # type: ignore[attr-defined]


def check_experiments(platform: Platform, file: str) -> None:
    """Raise InputError, naming the platform's file and the key, for the first that its `experiments` have wrong."""
    experiment_settings(platform, file)
    for fault in _missing_logs(platform, file):
        raise fault


def experiment_faults(platform: Platform, file: str) -> list[InputError]:
    """All that a platform's `experiments` have wrong; none where `check_experiments` would pass them."""
    return faults_of(_File, {"experiments": platform.experiments}, file) or _missing_logs(platform, file)


def compared_platforms(platform: Platform, file: str) -> list[str]:
    """Names of the platforms that a platform's experiments compare it with; checks them first."""
    check_experiments(platform, file)
    return list(dict.fromkeys(name for one in EXPERIMENTS for name in one.compared_with(platform)))


def _missing_logs(platform: Platform, file: str) -> list[InputError]:
    """Experiments that are wanted and need a raw navigation log, of a platform whose views hold body poses."""
    if platform.source.kind == "scans" or not noise_model(platform.noise_model).removes_outliers:
        return []
    found, expected = "an experiment that needs a raw navigation log", "a source of kind scans, which has one"
    return [
        InputError(f"{file}: experiments.{one.name}", found, expected, "remove it: labelled views hold body poses")
        for one in EXPERIMENTS
        if one.log and one.is_wanted(platform)
    ]
