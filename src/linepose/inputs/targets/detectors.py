"""Which detector finds a target."""

from linepose.errors import InputError
from linepose.inputs.targets.detect import Detector, ring_detector
from linepose.inputs.targets.refine import Refine
from linepose.survey.targets.base import TargetSection
from linepose.survey.targets.rings import RingsSection


def detector_of(target: TargetSection, refine: Refine) -> Detector:
    """What finds a target in a scan; raises InputError where there is nothing to be found."""
    if isinstance(target, RingsSection):
        return ring_detector(target, refine)
    raise InputError("target.kind", target.kind, "a pattern that is found without labels", "set source.points: labels")
