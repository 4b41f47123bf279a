"""What each single observation does to the pose."""

import logging
from typing import Final

import pandas as pd
import pyarrow as pa
from numpy.typing import ArrayLike

from linepose.estimation.estimator import Estimator
from linepose.experiments.estimate import estimate_fields, estimate_row
from linepose.experiments.experiment import Experiment
from linepose.experiments.inputs import Inputs
from linepose.experiments.repeatability import SECTION
from linepose.geometry.distance import euclidean_distance_m, geodesic_angle_rad, mahalanobis_distance
from linepose.tables import floats, whole_numbers

_logger = logging.getLogger(__name__)

LEAVE_ONE_OUT: Final = pa.schema(
    [*whole_numbers("left_out"), *estimate_fields(), *floats("distance_m", "angle_rad", "influence")]
)


def leave_one_out(estimator: Estimator, pose: ArrayLike, covariance: ArrayLike) -> pd.DataFrame:
    """One row an observation: the pose without it, and its influence, how far that lies from the full estimate.

    The influence is a distance in sigmas of the full estimate, a pose (6,) with its covariance (6, 6).
    """
    rows = []
    numbers = estimator.survey.number.tolist()
    for number in numbers:
        rest = estimator.select([other for other in numbers if other != number])
        without = rest.estimate(pose)
        rows.append(
            {
                "left_out": number,
                **estimate_row(without),
                "distance_m": float(euclidean_distance_m(without.pose, pose)),
                "angle_rad": float(geodesic_angle_rad(without.pose, pose)),
                "influence": float(mahalanobis_distance(without.pose, pose, covariance)),
            }
        )
    return pd.DataFrame(rows)


def _run(inputs: Inputs) -> dict[str, pd.DataFrame]:
    reference = inputs.reference
    table = leave_one_out(inputs.data.accepted, reference.pose, reference.covariance)
    worst = table.loc[table["influence"].idxmax()]
    _logger.info("most influential: observation %d, %.2f sigmas", worst["left_out"], worst["influence"])
    return {"leave_one_out": table}


EXPERIMENT: Final = Experiment(
    name="leave_one_out",
    title="Each observation left out",
    outputs={"leave_one_out": LEAVE_ONE_OUT},
    run=_run,
    section=SECTION,
)
