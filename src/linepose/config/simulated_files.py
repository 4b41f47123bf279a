"""Whether a simulated platform reads what its simulation writes."""

from typing import Final

from linepose.inputs.patterns import is_of
from linepose.inputs.source import ScansSection
from linepose.settings import SettingsError

_NAVIGATION: Final = "navigation.parquet"
_LABELS: Final = "labels.csv"
_COVARIANCES: Final = "covariances.csv"
_SCANS: Final = {"simulation": "scans/observation-01.hdr", "flight": "scans/strip-01.hdr"}


def check_simulated_files(source: ScansSection, origin: str) -> None:
    """Raise SettingsError for a source that names a file which a platform of this `origin` does not write."""
    navigation = source.navigation
    named = {
        "scans": (source.scans, _SCANS[origin]),
        "navigation": (navigation if isinstance(navigation, str) else navigation.file, _NAVIGATION),
        "covariances": (source.covariances, _COVARIANCES),
    }
    if source.points == "labels":
        named["labels"] = (source.labels, _LABELS)
    if source.points == "labels" and origin == "flight":
        found = "labels, which a simulated flight does not write"
        raise SettingsError(found, "matching", "set source.points: matching", "source.points")
    for key, (name, written) in named.items():
        if name is not None and not is_of(written, name):
            expected = f"{written}, which the simulation writes"
            raise SettingsError(repr(name), expected, "leave it out, or correct it", f"source.{key}")
    if source.time_stamps != "csv":
        found, remedy = source.time_stamps, "leave source.time_stamps out"
        raise SettingsError(found, "csv, which the simulation writes", remedy, "source.time_stamps")
