"""What is told of one platform: its pose in every representation, and whether to trust it."""

from dataclasses import dataclass

from linepose.arrays import Floats
from linepose.estimation.noise_models import noise_model
from linepose.pipeline.calibration import Calibration
from linepose.pipeline.evidence import angles, gather_evidence, pose_numbers
from linepose.pipeline.pose_tables import PoseNumber
from linepose.pipeline.verdict import Verdict, judge


@dataclass(frozen=True)
class PlatformSummary:
    """One platform in short, for the report and the terminal."""

    name: str
    description: str
    noise_model: str
    verdict: Verdict
    rotation_vector: list[PoseNumber]
    euler: list[PoseNumber]
    quaternion: Floats
    n_observations: int
    n_accepted: int
    neg_log_likelihood: float
    simulated: bool

    @property
    def removes_outliers(self) -> bool:
        """Whether the noise model removes observations; the adjustment weights them."""
        return noise_model(self.noise_model).removes_outliers

    @property
    def observations_in_words(self) -> str:
        """How many observations the pose rests on."""
        if self.removes_outliers:
            return f"{self.n_accepted} of {self.n_observations} observations accepted"
        return f"all {self.n_observations} observations, each with its weight"

    @property
    def misfit_in_words(self) -> str:
        """What the search made least, at the pose."""
        name = "-log L" if self.removes_outliers else "half of chi squared"
        return f"{name} {self.neg_log_likelihood:.3f}"

    @property
    def plain_pose(self) -> list[PoseNumber]:
        """Position and Euler angles, or the rotation vector where they do not tell the rotation."""
        return self.rotation_vector[:3] + (self.euler or self.rotation_vector[3:])


def summarise(calibration: Calibration) -> PlatformSummary:
    """The summary of a calibration with all its stages; raises InputError for a result that cannot be used."""
    evidence = gather_evidence(calibration)
    description = calibration.platform.description if calibration.platform else ""
    return PlatformSummary(
        name=calibration.name,
        description=description or calibration.name,
        noise_model=calibration.noise_model,
        verdict=judge(evidence),
        rotation_vector=pose_numbers(calibration),
        euler=angles(calibration),
        quaternion=calibration.quaternion_wxyz,
        n_observations=evidence.n_observations,
        n_accepted=evidence.n_accepted,
        neg_log_likelihood=calibration.neg_log_likelihood,
        simulated=calibration.true_pose is not None,
    )
