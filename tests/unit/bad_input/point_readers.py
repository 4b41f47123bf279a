"""Readers of labels, of what is known of points, of the ground, and of covariances and views in files of numbers."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from linepose.inputs.control_points import read_control_points
from linepose.inputs.labels.labelled_views import read_labelled_views
from linepose.inputs.labels.reading import read_point_labels
from linepose.inputs.local_frame import tangent_frame
from linepose.inputs.navigation.covariance_file import read_covariances
from linepose.inputs.terrain import read_terrain
from unit.bad_input.holds import covariances_hold, labels_hold, points_hold, views_hold
from unit.bad_input.reader import CASES, TIME_US, Reader, written
from unit.inputs import test_height_raster
from unit.inputs.drive import ORIGIN
from unit.inputs.labels import test_tools

CVAT = b"""<?xml version="1.0" encoding="utf-8"?>
<annotations><version>1.1</version>
<image id="0" name="run-01.png" width="640" height="100">
<points label="point" points="10.5,20.5"><attribute name="id">7</attribute></points>
<points label="8" points="30.5,40.5"></points>
</image></annotations>
"""
LABELS = b"observation,point,u_px,line\n1,0,10.5,20\n1,1,30.25,40\n1,2,50,60.5\n"
CONTROL_POINTS = {
    "own": (None, "id,north_m,east_m,down_m,sigma_m\nA,1.5,2.5,-3,0.01\nB,,,-2.5,0.02\n"),
    "projected": (
        "EPSG:32756",
        "id,easting_m,northing_m,height_m,sigma_horizontal_m,sigma_height_m\n"
        "A,332962.0,6248551.0,42.5,0.01,0.02\nB,332972.0,6248561.0,41.5,0.01,0.02\n",
    ),
    "geographic": (
        "EPSG:4326",
        "id,latitude_deg,longitude_deg,height_m,sigma_m\nA,-33.8892,151.1937,42.5,0.01\nB,-33.8893,151.1938,41,0.02\n",
    ),
}


def _labels(name: str, tool: str, data: bytes, file: str) -> Reader:
    scans = {1: Path("run-01.hdr"), 3: Path("run-03.bil.hdr")}

    def read(folder: Path) -> Any:
        return read_point_labels(folder, file, scans, 640)

    return Reader(name, lambda: {file: data}, file, read, labels_hold, True, (f"labels {tool}",))


def _control_points(name: str) -> Reader:
    crs, text = CONTROL_POINTS[name]

    def read(folder: Path) -> Any:
        return read_control_points(folder / "points.csv", crs, tangent_frame(ORIGIN))

    files = {"points.csv": text.encode()}
    return Reader(
        f"control points {name}", lambda: files, "points.csv", read, points_hold, True, ("points.control_points",)
    )


def _heights() -> dict[str, bytes]:
    heights = np.arange(400.0).reshape(20, 20)
    return {"dem.tif": written(lambda path: test_height_raster.write(path, [heights], nodata=-9999.0), "dem.tif")}


def _text_heights() -> dict[str, bytes]:
    head = "ncols 4\nnrows 3\nxllcorner 151.19\nyllcorner -33.89\ncellsize 0.001\nNODATA_value -9999\n"
    rows = "".join(" ".join(f"{4 * row + column}" for column in range(4)) + "\n" for row in range(3))
    system = 'GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],PRIMEM["Greenwich",0],'
    system += 'UNIT["degree",0.0174532925199433]]'
    return {"dem.asc": (head + rows).encode(), "dem.prj": system.encode()}


def _ground(name: str, make: Callable[[], dict[str, bytes]], file: str, is_text: bool) -> Reader:
    def read(folder: Path) -> Any:
        terrain = read_terrain(folder / file, tangent_frame(ORIGIN), np.zeros(3), 0.0)
        return terrain, terrain.covers(np.zeros((1, 2)))

    def holds(value: Any) -> bool:
        return bool(np.all(np.isfinite(value[0].heights_m)) and np.all(np.isfinite(value[0].to_cell)))

    return Reader(name, make, file, read, holds, is_text, ("points.ground.dem", "map.dem"))


def _covariances() -> bytes:
    covariance = np.diag(np.full(12, 1e-4)).ravel()
    return "\n".join(",".join([str(time), *(f"{one:g}" for one in covariance)]) for time in TIME_US[:3]).encode()


def _views() -> bytes:
    rows = (f"{time},{row},{300 + row},6.2,3.3,-1,0.01,0.02,0.3\n" for row, time in enumerate(TIME_US))
    return "".join(rows).encode()


def point_readers() -> list[Reader]:
    """All of them."""
    labelme = (CASES / "labelme_group_id" / "run-01.json").read_bytes()
    return [
        _labels("labels csv", "CSV", LABELS, "labels.csv"),
        _labels("cvat", "CVAT", CVAT, "annotations.xml"),
        _labels("cvat skeleton", "CVAT", (CASES / "cvat_skeleton_outside" / "annotations.xml").read_bytes(), "a.xml"),
        _labels("labelme", "LabelMe", labelme, "run-01.json"),
        _labels("coco", "COCO keypoints", json.dumps(test_tools.COCO).encode(), "labels.json"),
        _labels("label studio", "Label Studio", json.dumps(test_tools.STUDIO).encode(), "labels.json"),
        _labels("via", "VIA 2", json.dumps(test_tools.VIA).encode(), "labels.json"),
        _labels("via csv", "VIA 2", test_tools.via_csv().encode(), "labels.csv"),
        *(_control_points(name) for name in CONTROL_POINTS),
        _ground("height raster", _heights, "dem.tif", False),
        _ground("height raster as text", _text_heights, "dem.asc", True),
        Reader(
            "covariances",
            lambda: {"nav.csv": _covariances()},
            "nav.csv",
            lambda folder: read_covariances(folder / "nav.csv", (3, 4, 5)),
            covariances_hold,
            of=("covariances",),
        ),
        Reader(
            "labelled views",
            lambda: {"view.csv": _views()},
            "view.csv",
            lambda folder: read_labelled_views([folder / "view.csv"], 648),
            views_hold,
            of=("source labelled_views",),
        ),
    ]
