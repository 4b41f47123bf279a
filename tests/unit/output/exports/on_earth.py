"""The made-up strip where it can be told on the Earth: about the origin of a plane that touches it."""

from dataclasses import replace

import numpy as np
from pyproj import Transformer

from linepose.output.exports.map_frame import MapFrame
from linepose.output.map.frame import SurveyMap
from linepose.output.map.ground import flat_ground
from unit.output.map.made_up_scan import ORIGIN, scan

PLACE = MapFrame("EPSG:32756", (-33.89, 151.19, 40.0))
TO_GEODETIC = Transformer.from_crs("EPSG:4978", "EPSG:4979")


def on_earth(**changes):
    """The made-up strip about the origin of a plane that touches the Earth; the ground is 1 m below it."""
    strip = scan(ground=flat_ground(-1.0), **changes)
    log = replace(strip.navigation.log, position_m=strip.navigation.log.position_m - ORIGIN)
    return replace(strip, navigation=replace(strip.navigation, log=log), frame=SurveyMap(PLACE))


def earth_fixed(places):
    longitude, latitude, height = PLACE.wgs84(places).T
    return np.stack(TO_GEODETIC.transform(latitude, longitude, height, direction="INVERSE"), axis=-1)
