"""What the page says of the camera that was adjusted."""

from dataclasses import replace

import numpy as np

from linepose.output.report.intrinsics import intrinsics_on_page, intrinsics_sentence
from linepose.pipeline.adjusted_intrinsics import AdjustedIntrinsics

FOUND = AdjustedIntrinsics(
    ("principal_point_px", "focal_length_m", "smile", "tilt"),
    np.array([323.4, 8.25e-3, 0.012, 1e-4]),
    np.diag([1.9, 1e-5, 1e-3, 4.9e-3]) ** 2,
    np.zeros((6, 4)),
    np.array([323.0, 8.2e-3, 0.0, 0.0]),
    np.array([2.0, 1e-4, 0.01, 5e-3]),
)


def test_what_the_survey_tells_and_what_it_leaves_to_the_prior():
    assert intrinsics_sentence(FOUND) == (
        "Of the camera the survey tells focal length and smile, and it leaves principal point and tilt to the platform "
        "file's sigmas."
    )
    alone = replace(FOUND, prior_sigma=np.full(4, 1e9))
    assert intrinsics_sentence(alone).startswith("Of the camera the survey tells principal point, focal length, smile ")
    nothing = replace(FOUND, prior_sigma=np.full(4, 1e-9))
    assert intrinsics_sentence(nothing).startswith("Of the camera the survey leaves principal point, focal length")


def test_each_stands_beside_its_prior():
    rows = intrinsics_on_page("camera", FOUND).rows
    assert rows[1] == ["focal length (mm)", "8.25 ± 0.01", "8.2 ± 0.1", "survey"]
    assert rows[3] == ["tilt", "0.0001 ± 0.0049", "0 ± 0.005", "prior"]
