"""Navigation logs as devices write them: one format a file, chosen by name in the platform file.

`read_navigation(source.navigation, folder)` reads any of them; to add one, see docs/formats.md.
"""

from linepose.config.navigation_formats import GeodeticSection, NavigationFormat, NavigationFormatSection
from linepose.inputs.navigation.reading import log_covariances, read_navigation
from linepose.inputs.navigation.record import Covariances, NavigationRecord, Poses, geodetic_record, local_record

__all__ = [
    "Covariances",
    "GeodeticSection",
    "NavigationFormat",
    "NavigationFormatSection",
    "NavigationRecord",
    "Poses",
    "geodetic_record",
    "local_record",
    "log_covariances",
    "read_navigation",
]
