"""All kinds of targets, in the order in which people are told of them; a new kind is a file and a row here."""

from collections.abc import Mapping
from typing import Annotated, Any, Final

from pydantic import BeforeValidator, Field

from linepose.errors import quoted
from linepose.settings import SettingsError
from linepose.survey.targets.apriltags import ApriltagsSection
from linepose.survey.targets.base import GridSection, TargetSection
from linepose.survey.targets.charuco import CharucoSection
from linepose.survey.targets.chessboard import ChessboardSection
from linepose.survey.targets.dots import DotsSection
from linepose.survey.targets.points import PointsSection
from linepose.survey.targets.rings import RingsSection

AnyTarget = RingsSection | DotsSection | ChessboardSection | CharucoSection | ApriltagsSection | PointsSection
KINDS: Final[dict[str, type[TargetSection]]] = {
    section.model_fields["kind"].default: section for section in AnyTarget.__args__
}
PRINTED: Final[dict[str, type[GridSection]]] = {
    name: section for name, section in KINDS.items() if issubclass(section, GridSection)
}


def _of_a_known_kind(values: Any) -> Any:
    if isinstance(values, Mapping) and not (isinstance(values.get("kind"), str) and values["kind"] in KINDS):
        found = quoted(values["kind"]) if "kind" in values else "nothing"
        raise SettingsError(found, f"one of {', '.join(KINDS)}", "correct it", "kind")
    return values


Target = Annotated[AnyTarget, Field(discriminator="kind"), BeforeValidator(_of_a_known_kind)]
