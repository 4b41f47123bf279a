"""What the experiments start from: the accepted observations' likelihood, their optimum, and its sampled covariance."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from linepose.arrays import Floats
from linepose.config.experiments import RepeatabilitySection, SubsetSection
from linepose.config.platform import Platform
from linepose.estimation.outliers import stage_observations
from linepose.experiments.subsets import check_subset, draw_by_rules
from linepose.geometry.pose import N_PARAMETERS
from linepose.likelihood.base import Likelihood
from linepose.pipeline.platform_likelihood import platform_likelihood
from linepose.pipeline.result_schemas import OBSERVATIONS, OPTIMA, OUTLIERS, SAMPLES
from linepose.pipeline.stages import samples_from_table
from linepose.survey.observations import survey_from_table
from linepose.tables import read_table


@dataclass(frozen=True)
class Accepted:
    """A platform's likelihood of all its observations, `all`, and of those that the outlier removal accepted."""

    all: Likelihood
    accepted: Likelihood

    def subset(self, section: SubsetSection, place: str) -> tuple[int, ...]:
        """Observation numbers that a configured subset names or draws; raises InputError, naming `place`."""
        survey = self.accepted.survey
        numbers = tuple(section.observations) or draw_by_rules(
            survey, [rule.rule() for rule in section.rules], section.seed, place
        )
        check_subset(numbers, survey.number, self.all.survey.number, place)
        return numbers

    def subsets(self, sections: Mapping[str, SubsetSection], place: str) -> dict[str, Sequence[int]]:
        """Observation numbers of each configured subset, by name."""
        return {name: self.subset(section, f"{place}.{name}") for name, section in sections.items()}


@dataclass(frozen=True)
class Reference:
    """The accepted observations' optimum (P,) and the pose's sampled covariance (6, 6)."""

    parameters: Floats
    covariance: Floats

    @property
    def pose(self) -> Floats:
        """The optimum's pose (6,)."""
        return self.parameters[:N_PARAMETERS]


def read_accepted(platform: Platform, observations: Path | str, outliers: Path | str) -> Accepted:
    """From the results of the stages `associate` and `reject_outliers`."""
    survey = survey_from_table(read_table(observations, OBSERVATIONS))
    likelihood = platform_likelihood(platform, survey)
    inliers = stage_observations(read_table(outliers, OUTLIERS))["inliers"]
    return Accepted(likelihood, likelihood.select(inliers))


def read_others(
    others: Mapping[str, Mapping[str, object]], observations: Sequence[str], outliers: Sequence[str]
) -> dict[str, Accepted]:
    """The same of other platforms, by name: what their files say, and their results in the same order."""
    files = zip(observations, outliers, strict=True)
    return {
        name: read_accepted(Platform.model_validate(values), *pair)
        for (name, values), pair in zip(others.items(), files, strict=True)
    }


def named_pair(data: Accepted, section: RepeatabilitySection | None, file: str) -> dict[str, Sequence[int]]:
    """Observation numbers of the two disjoint subsets that a platform's file names; none where it names none."""
    if section is None or section.first is None or section.second is None:
        return {}
    return data.subsets({"subset_1": section.first, "subset_2": section.second}, f"{file}: experiments.repeatability")


def read_reference(likelihood: Likelihood, optima: Path | str, samples: Path | str) -> Reference:
    """From the results of the stages `optimise` and `sample`; `samples` is the folder of all stages' samples."""
    names = list(likelihood.parameter_names)
    optimum = read_table(optima, OPTIMA).set_index("stage").loc["inliers", names]
    chain = samples_from_table(read_table(Path(samples) / "inliers.parquet", SAMPLES), names[:N_PARAMETERS])
    return Reference(optimum.to_numpy(dtype=float, copy=True), np.cov(chain.reshape(-1, N_PARAMETERS).T))
