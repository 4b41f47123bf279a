"""The pose as CSV for spreadsheets: one row a parameter, its sigma, and its row of the covariance."""

from pathlib import Path
from typing import TYPE_CHECKING, Final

from linepose.pipeline.exports.format import ExportFormat
from linepose.pipeline.exports.options import ExportOptions

if TYPE_CHECKING:
    from linepose.pipeline.calibration import Calibration


def write_csv_pose(calibration: "Calibration", options: ExportOptions, path: Path) -> None:
    """Write six rows: what and where, parameter, value, sigma, covariance with each parameter."""
    import pandas as pd

    from linepose.geometry.pose import POSE_COLUMNS

    estimate = calibration.estimate.in_axes(options.body_axes or "frd")
    table = pd.DataFrame(
        {
            "platform": calibration.name,
            "stage": calibration.stage,
            "body_axes": estimate.body_axes,
            "parent_frame": options.parent_frame,
            "child_frame": options.child_frame,
            "parameter": list(POSE_COLUMNS),
            "value": estimate.pose,
            "sigma": estimate.sigma,
            **{f"covariance_{name}": estimate.covariance[:, k] for k, name in enumerate(POSE_COLUMNS)},
        }
    )
    table.to_csv(path, index=False, lineterminator="\n")


FORMAT: Final = ExportFormat("csv", "pose with covariance, one row a parameter", ".csv", write_csv_pose)
