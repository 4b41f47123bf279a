"""What random splits say of the sigmas."""

import numpy as np
import pandas as pd
from scipy.stats import chi

from linepose.arrays import Floats
from linepose.errors import EstimationError
from linepose.geometry.pose import N_PARAMETERS


def known_distances(splits: pd.DataFrame) -> Floats:
    """Distances in sigmas (K,) of the splits that determine both poses.

    `splits` as in `schemas.SPLITS`; raises EstimationError where there is none.
    """
    distance = splits["mahalanobis"].to_numpy(dtype=float)
    known = distance[np.isfinite(distance)]
    if not known.size:
        raise EstimationError(
            "random splits: none determines both poses; lower repeatability.split_size is no remedy, "
            "more observations are"
        )
    return known


def sigma_factor(splits: pd.DataFrame) -> float:
    """By how much the sigmas would have to grow for the splits' median distance to be what right sigmas give."""
    return float(np.median(known_distances(splits)) / chi.median(N_PARAMETERS))
