"""What extraction makes of a simulated survey's scans, held against the truth: each refinement, and detection."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
import pyarrow as pa
from numpy.typing import NDArray

from linepose.arrays import Floats
from linepose.inputs.observed_points import detected_in, scan_points
from linepose.inputs.targets.accuracy import accuracy, compare_methods
from linepose.inputs.targets.detect import Detection, Detector
from linepose.inputs.targets.refine import METHODS, REFINEMENTS, Refine
from linepose.survey.targets.base import TargetSection
from linepose.tables import flags, floats, optional_floats, texts, whole_numbers

_SCAN: Final = [*whole_numbers("observation", "n_lines"), *floats("range_m", "v_px_per_line")]
EXTRACTION_ACCURACY: Final = pa.schema(
    [
        *_SCAN,
        *texts("method"),
        *flags("chosen"),
        *whole_numbers("n_points", "n_missing"),
        *optional_floats("bias_u_px", "sigma_u_px", "bias_v_px", "sigma_v_px"),  # none of fewer than two points
    ]
)
DETECTION: Final = pa.schema([*_SCAN, *whole_numbers("n_visible", "n_found", "n_wrong"), *texts("doubt")])
DETECTED: Final = "detected"
_PLACE = ["u_px", "line"]


@dataclass(frozen=True)
class DetectedBoard:
    """The board in simulated scans, what finds it without labels, and the chosen method of `REFINEMENTS`."""

    target: TargetSection
    detector: Detector
    refinement: str

    def methods(self) -> dict[str, Refine]:
        """What refines its points from labels: every method of dots and the chosen one; none for corners."""
        return {} if self.target.feature != "dot" else METHODS | {self.refinement: REFINEMENTS[self.refinement]}


@dataclass(frozen=True)
class MeasuredExtraction:
    """Tables: `accuracy` of each method and `detection`, a row an observation, and the detected `points`.

    Columns as in `EXTRACTION_ACCURACY`, `DETECTION` and `SCAN_POINTS`.
    """

    accuracy: pd.DataFrame
    detection: pd.DataFrame
    points: pd.DataFrame


def measure_extraction(
    scans: Mapping[int, Path],
    labels: pd.DataFrame,
    truth: pd.DataFrame,
    board: DetectedBoard,
    n_pixels: int,
) -> MeasuredExtraction:
    """Find all points of the board without labels, refine dots from labels by every method, compare with the truth.

    A label counts for the true point that it is nearest to, whatever id it carries. Corners have no such method: their
    one row is of the points that are found (`DETECTED`).
    """
    accuracies, detections, points = [], [], []
    ids, methods = np.array(board.target.ids()), board.methods()
    for number, _, scan, found in detected_in(scans, board.detector, n_pixels):
        visible = truth[(truth["observation"] == number) & truth["visible"]]
        exact, rate = visible[_PLACE].to_numpy(), visible["v_px_per_line"].to_numpy()
        view = {
            "observation": number,
            "range_m": visible["range_m"].mean(),
            "v_px_per_line": rate.mean(),
            "n_lines": len(scan.intensity),
        }
        if methods:
            rough = labels.loc[labels["observation"] == number, _PLACE].to_numpy()
            meant = nearest(rough, exact)
            measured = compare_methods(methods, scan.intensity, rough, exact[meant], rate[meant])
        else:
            meant = nearest(found.position, exact)
            measured = pd.DataFrame([{"method": DETECTED} | accuracy(found.position, exact[meant], rate[meant])])
        accuracies.append(measured.assign(**view))
        detections.append(view | _detection_counts(found, ids[visible["point"].to_numpy()], exact))
        points.append(scan_points(number, scan, found.point, found.position))
    accuracy_of_all = pd.concat(accuracies, ignore_index=True)
    return MeasuredExtraction(
        accuracy_of_all.assign(chosen=accuracy_of_all["method"] == (board.refinement if methods else DETECTED)),
        pd.DataFrame(detections),
        pd.concat(points, ignore_index=True),
    )


def _detection_counts(found: Detection, visible: NDArray[np.int64], exact: Floats) -> dict[str, int | str]:
    """How many points are visible, were found, and carry the id of another point than the one they lie on."""
    wrong = visible[nearest(found.position, exact)] != found.point
    return {
        "n_visible": len(visible),
        "n_found": len(found.point),
        "n_wrong": int(wrong.sum()),
        "doubt": found.doubt,
    }


def nearest(position: Floats, others: Floats) -> NDArray[np.int64]:
    """Row of the nearest of positions (M, 2) to each of positions (K, 2), both axes in parts of their extent; (K,)."""
    extent = np.ptp(others, axis=0)
    return np.argmin(np.linalg.norm((position[:, None] - others) / extent, axis=-1), axis=1)
