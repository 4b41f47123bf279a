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
from linepose.inputs.targets.accuracy import compare_methods
from linepose.inputs.targets.detect import Detection, ring_detector
from linepose.inputs.targets.refine import METHODS
from linepose.survey.targets.rings import RingsSection
from linepose.tables import flags, floats, texts, whole_numbers

_SCAN: Final = [*whole_numbers("observation", "n_lines"), *floats("range_m", "v_px_per_line")]
EXTRACTION_ACCURACY: Final = pa.schema(
    [
        *_SCAN,
        *texts("method"),
        *flags("chosen"),
        *whole_numbers("n_points", "n_missing"),
        *floats("bias_u_px", "sigma_u_px", "bias_v_px", "sigma_v_px"),
    ]
)
DETECTION: Final = pa.schema([*_SCAN, *whole_numbers("n_visible", "n_found", "n_wrong"), *texts("doubt")])
_PLACE = ["u_px", "line"]


@dataclass(frozen=True)
class MeasuredExtraction:
    """Tables: `accuracy` of each method and `detection`, a row an observation, and the detected `points`.

    Columns as in `EXTRACTION_ACCURACY`, `DETECTION` and `SCAN_POINTS`.
    """

    accuracy: pd.DataFrame
    detection: pd.DataFrame
    points: pd.DataFrame


def measure_extraction(
    scans: Mapping[int, Path], labels: pd.DataFrame, truth: pd.DataFrame, chosen: str, n_pixels: int
) -> MeasuredExtraction:
    """Refine all labels by every method, find all points without labels by the chosen one, compare with the truth.

    A label counts for the true point that it is nearest to, whatever id it carries.
    """
    accuracies, detections, points = [], [], []
    for number, _, scan, found in detected_in(scans, ring_detector(RingsSection(), METHODS[chosen]), n_pixels):
        visible = truth[(truth["observation"] == number) & truth["visible"]]
        exact = visible[_PLACE].to_numpy()
        rough = labels.loc[labels["observation"] == number, _PLACE].to_numpy()
        meant = nearest(rough, exact)
        rate = visible["v_px_per_line"].to_numpy()
        view = {
            "observation": number,
            "range_m": visible["range_m"].mean(),
            "v_px_per_line": rate.mean(),
            "n_lines": len(scan.intensity),
        }
        accuracies.append(compare_methods(METHODS, scan.intensity, rough, exact[meant], rate[meant]).assign(**view))
        detections.append(view | _detection_counts(found, visible["point"].to_numpy(), exact))
        points.append(scan_points(number, scan, found.point, found.position))
    accuracy = pd.concat(accuracies, ignore_index=True)
    return MeasuredExtraction(
        accuracy.assign(chosen=accuracy["method"] == chosen),
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
