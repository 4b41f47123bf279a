"""What a navigation format is: its name, its settings, and what reads its logs."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from pydantic import Field

from linepose.errors import InputError
from linepose.inputs.patterns import Files, matching
from linepose.settings import Settings

if TYPE_CHECKING:
    from linepose.inputs.navigation.record import NavigationRecord


class NavigationFormatSection(Settings):
    """Keys of every navigation format; a format adds its own, and narrows `format` to its name."""

    format: str
    file: Files = Field(
        description="Log below the data set's folder, or a pattern of logs (`run-*.gps`) that follow in time."
    )

    def paths(self, folder: Path) -> list[Path]:
        """The logs, sorted by name; raises InputError where there is none."""
        found = matching(folder, self.file)
        if not found:
            remedy = "restore it, or correct source.navigation.file"
            raise InputError(str(folder / self.file), "no such file", "a navigation log", remedy)
        return found

    def files(self, folder: Path) -> set[Path]:
        """Every file that is read; those of a log that is a folder one by one."""
        return with_contents(matching(folder, self.file))

    def lacking(self, folder: Path) -> Literal["gps_week", "date"] | None:  # noqa: ARG002
        """The key that the scans' first time stamp gives, where the log counts from a day that it does not say."""
        return None


def correct_keys(section: NavigationFormatSection | None, names: Sequence[str], otherwise: str) -> str:
    """The remedy of correcting those of these keys that the format has, of its log of attitudes where that has them.

    `otherwise` where it has none of them.
    """
    beside = getattr(section, "attitude_log", None)
    at, keys = ("source.navigation", section) if beside is None else ("source.navigation.attitude_log", beside)
    *first, last = ["", *(name for name in names if name in getattr(type(keys), "model_fields", ()))]
    together = " or ".join(one for one in (", ".join(first[1:]), last) if one)
    return f"correct {at}.{together}" if together else otherwise


class GeodeticSection(NavigationFormatSection):
    """Keys of the formats whose positions are latitude, longitude and ellipsoidal height (WGS 84)."""

    frame: Literal["tangent", "projected"] = Field(
        "tangent",
        description="Where positions are taken: in the plane that touches the Earth at `origin`, true in lengths, or "
        "in the projected `crs`.",
    )
    origin: tuple[float, float, float] | None = Field(
        None,
        description="Origin of the tangent plane: latitude, longitude (deg), ellipsoidal height (m); if not given, the "
        "log's first record.",
    )
    crs: str | None = Field(
        None, description="The projected CRS, as in EPSG:32633; if not given, the UTM zone of the log's first record."
    )


def _is_not_recognised(_: Path) -> None:
    """No file is taken for a log of the format."""


def _has_no_keys(_: Any, corrections: Sequence[str]) -> Sequence[Mapping[str, Any]]:  # noqa: ARG001
    """No key of the format tells of axes, signs or units."""
    return ()


@dataclass(frozen=True)
class NavigationFormat:
    """A navigation format: its name, the model of its keys, and what reads the logs of a data set's folder.

    `read` takes the section and the folder and returns a linepose.inputs.navigation.NavigationRecord.
    `has_covariances`: whether such logs as a rule hold covariances, so that no file of their own is needed.
    `recognise` returns the keys beside `format` and `file` that a log of this format needs, None for any other file.
    `keys_against` returns, from the section and names of navigation.corrections, in which ways keys of the format may
    say what these corrections would undo: each way keys, their parts apart by dots, with values.
    """

    name: str
    section: type[NavigationFormatSection]
    read: "Callable[[Any, Path], NavigationRecord]"
    has_covariances: bool = True
    recognise: "Callable[[Path], dict[str, Any] | None]" = _is_not_recognised
    keys_against: "Callable[[Any, Sequence[str]], Sequence[Mapping[str, Any]]]" = _has_no_keys


def with_contents(paths: Iterable[Path]) -> set[Path]:
    """The paths, and instead of each folder the files below it."""
    return {file for path in paths for file in (path.rglob("*") if path.is_dir() else [path]) if not file.is_dir()}
