"""How the pose moves when settings, data or single observations change: a section of a platform's part of the page."""

import numpy as np
import pandas as pd

from linepose.arrays import Floats
from linepose.experiments.leave_one_out import LEAVE_ONE_OUT
from linepose.experiments.sensitivity import SENSITIVITY
from linepose.experiments.subsets import SUBSETS
from linepose.geometry.distance import pose_difference
from linepose.geometry.pose import POSE_COLUMNS
from linepose.output.report.sections import SectionOnPage, TableOnPage
from linepose.pipeline.calibration import Calibration

_HEADS = ("Change", "Observations", "Forward (mm)", "Right (mm)", "Down (mm)", "Turn (°)", "Together (sigmas)")


def influence_section(calibration: Calibration) -> SectionOnPage | None:
    """What the experiments on settings and on the choice of observations found, as far as they were run."""
    pose = calibration.pose_of("inliers")
    tables: list[TableOnPage] = []
    told: list[str] = []
    if calibration.results.has("sensitivity"):
        changes = calibration.results.table("sensitivity", SENSITIVITY)
        changes = changes.iloc[1:]  # after the nominal one
        farthest = changes.loc[changes["distance_m"].idxmax()]
        told.append(
            f"Of the changes tried, {farthest['change']} moves the camera most: by "
            f"{1e3 * farthest['distance_m']:.0f} mm and {np.degrees(farthest['angle_rad']):.2f}°."
        )
        rows = _rows(changes["change"], changes, changes["mahalanobis"], pose)
        tables.append(_table(calibration.name, "settings", "Other settings and data", rows))
    if calibration.results.has("leave_one_out"):
        without = calibration.results.table("leave_one_out", LEAVE_ONE_OUT)
        without = without.sort_values("influence", ascending=False)
        told.append(
            f"Without observation {without['left_out'].iloc[0]} it moves by {1e3 * without['distance_m'].iloc[0]:.0f} "
            f"mm and {np.degrees(without['angle_rad'].iloc[0]):.2f}°, more sigmas than without any other."
        )
        names = without["left_out"].map("without {}".format)
        tables.append(
            _table(
                calibration.name,
                "left-out",
                "Without one observation",
                _rows(names, without, without["influence"], pose),
            )
        )
    if calibration.results.has("subsets"):
        subsets = calibration.results.table("subsets", SUBSETS)
        rows = _rows(subsets["subset"], subsets, pd.Series(np.nan, subsets.index), pose)
        tables.append(_table(calibration.name, "subsets", "Subsets of the observations", rows))
    if not tables:
        return None
    text = f"How the pose moves when something else changes. {' '.join(told)}"
    return SectionOnPage(f"{calibration.name}-depends", "What the pose depends on", text.strip(), tables)


def _rows(names: pd.Series, estimates: pd.DataFrame, sigmas: pd.Series, pose: Floats) -> list[list[str]]:
    moved = pose_difference(np.array(estimates[list(POSE_COLUMNS)]), pose)
    turned_deg = np.degrees(np.linalg.norm(moved[:, 3:], axis=1))
    return [
        [
            str(name),
            str(count),
            *(f"{value + 0.0:+.0f}" for value in np.round(1e3 * move[:3])),  # never -0
            f"{angle:.2f}",
            "" if np.isnan(distance) else f"{distance:.1f}",
        ]
        for name, count, move, angle, distance in zip(
            names, estimates["n_observations"], moved, turned_deg, sigmas, strict=True
        )
    ]


def _table(platform: str, anchor: str, title: str, rows: list[list[str]]) -> TableOnPage:
    return TableOnPage(f"{platform}-depends-{anchor}", title, f"{len(rows)} estimates", _HEADS, rows)
