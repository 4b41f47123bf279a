"""The pose as CSV for spreadsheets: one row a parameter, its sigma, and its row of the covariance."""

from pathlib import Path

import pandas as pd

from linepose.geometry.pose import POSE_COLUMNS
from linepose.output.exports.calibration import Calibration
from linepose.output.exports.options import ExportOptions


def write_csv_pose(calibration: Calibration, options: ExportOptions, path: Path) -> None:
    """Write six rows: what and where, parameter, value, sigma, covariance with each parameter."""
    table = pd.DataFrame(
        {
            "platform": calibration.platform,
            "stage": calibration.stage,
            "body_axes": calibration.body_axes,
            "parent_frame": options.parent_frame,
            "child_frame": options.child_frame,
            "parameter": list(POSE_COLUMNS),
            "value": calibration.pose,
            "sigma": calibration.sigma(),
            **{f"covariance_{name}": calibration.covariance[:, k] for k, name in enumerate(POSE_COLUMNS)},
        }
    )
    table.to_csv(path, index=False, lineterminator="\n")
