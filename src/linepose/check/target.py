"""Whether the scans can show the target, as far as it is described and its distance known."""

from linepose.check.finding import Finding, error, ok
from linepose.geometry.camera import Camera
from linepose.inputs.source import LabelledViewsSection, ScansSection
from linepose.inputs.targets.surfaces import farthest_m
from linepose.survey.targets.base import GridSection, TargetSection


def target_findings(
    target: TargetSection, camera: Camera, source: LabelledViewsSection | ScansSection
) -> list[Finding]:
    """Whether a target that is to be found without labels is large enough; nothing where its distance is not known."""
    if not isinstance(source, ScansSection) or source.points != "detection" or source.target_range_m is None:
        return []
    if not isinstance(target, GridSection):
        return []
    farthest, range_m = farthest_m(target, camera), source.target_range_m
    if range_m <= farthest:
        return [ok("target", f"{target.kind}: large enough to be found up to {farthest:.1f} m away")]
    found = (
        f"{target.kind} too small to be found from {range_m:g} m: its details take enough pixels up to {farthest:.1f} m"
    )
    return [error("target", found, "print it larger or come closer, or correct source.target_range_m")]
