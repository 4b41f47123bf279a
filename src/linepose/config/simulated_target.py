"""The target of a simulated platform: what its scans show is what the platform's file describes."""

from typing import Final

from linepose.settings import SettingsError
from linepose.survey.targets.base import TargetSection

_REMEDY: Final = "give both the same keys; the one that is left out is the paper's board"
_OF_KNOWLEDGE: Final = frozenset({"known", "sigma_m"})  # of a target, that say nothing of its print


def check_simulated_target(target: TargetSection, simulated: TargetSection) -> None:
    """Raise SettingsError where `target` describes another print than `simulation.board.target`.

    A target without a pattern, whose points are labelled by name, may stand for any.
    """
    if target.artwork() is None:
        return
    given, stands = target.model_dump(exclude=set(_OF_KNOWLEDGE)), simulated.model_dump(exclude=set(_OF_KNOWLEDGE))
    for key in ["kind", *given]:
        if given[key] != stands.get(key):
            found = f"target.{key} {given[key]} with simulation.board.target.{key} {stands.get(key)}"
            raise SettingsError(found, "the board that the simulated scans show", _REMEDY)
