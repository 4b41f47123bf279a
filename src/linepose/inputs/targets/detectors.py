"""Which detector finds a target."""

from collections.abc import Callable
from typing import TYPE_CHECKING

from linepose.errors import InputError
from linepose.inputs.targets.detect import Detector, ring_detector
from linepose.inputs.targets.refine import AS_LABELLED, REFINEMENTS
from linepose.survey.targets.base import RectifiedSection, TargetSection
from linepose.survey.targets.rings import RingsSection

if TYPE_CHECKING:  # what rectifies scans is compiled, and imported when it is needed
    from linepose.inputs.targets.rectified import HandView


def detector_of(target: TargetSection, refinement: str, view: "Callable[[], HandView]") -> Detector:
    """What finds a target in a scan; `view` is asked for where scans must be rectified for it.

    Raises InputError where there is nothing to be found.
    """
    if isinstance(target, RingsSection):
        return ring_detector(target, REFINEMENTS[refinement])
    if isinstance(target, RectifiedSection):
        from linepose.inputs.targets.rectified import RectifiedDetector

        return RectifiedDetector(target, view(), refines=refinement != AS_LABELLED)
    raise InputError("target.kind", target.kind, "a pattern that is found without labels", "set source.points: labels")
