"""What counts as a covariance, wherever it comes from: symmetric, no negative eigenvalues but for rounding, not zero.

All are judged on correlations, so that metres and radians weigh alike.
"""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from linepose.arrays import Floats

ASYMMETRY: Final = 1e-9  # of a correlation: both halves are written alike
NEGATIVE: Final = 1e-5  # as an eigenvalue of correlations: what rounding to six printed digits may leave

COVARIANCE_WORDS: Final = "a covariance of north, east, down (m), roll, pitch, yaw (rad)"
COVARIANCE_REMEDY: Final = "give what the navigation system reports, or the sigmas of its data sheet"


def correlations(covariances: Floats) -> Floats:
    """Correlations (..., P, P) of covariances; rows and columns of a variance that is zero stay as they are.

    A negative variance stands as -1 on the diagonal.
    """
    sigma = np.sqrt(np.abs(np.diagonal(covariances, axis1=-2, axis2=-1)))
    safe = np.where(sigma > 0, sigma, 1.0)
    return covariances / safe[..., :, None] / safe[..., None, :]


def asymmetric(correlation: Floats) -> NDArray[np.bool_]:
    """Whether correlations (..., P, P) are not symmetric: (...)."""
    difference = np.abs(correlation - np.swapaxes(correlation, -1, -2))
    return np.asarray(difference.max(axis=(-2, -1)) > ASYMMETRY)


def least_eigenvalue(correlation: Floats) -> Floats:
    """The least eigenvalue (...) of correlations (..., P, P); below `-NEGATIVE` they are of no covariance."""
    return np.asarray(np.linalg.eigvalsh(correlation)[..., 0])


def first_unusable(covariances: Floats) -> tuple[int, str] | None:
    """Row of the first of covariances (K, 6, 6) of a body pose that is none, and what it is; None where all are of use.

    A variance that is zero is allowed, all six are not: no navigation system knows its pose exactly.
    """
    correlation = correlations(covariances)
    zero = ~np.any(covariances != 0, axis=(1, 2))
    skewed, negative = asymmetric(correlation), least_eigenvalue(correlation) < -NEGATIVE
    for row in np.flatnonzero(zero | skewed | negative)[:1]:
        if zero[row]:
            return int(row), "a covariance that is zero"
        return int(row), "a matrix that is not symmetric" if skewed[row] else "a covariance with a negative eigenvalue"
    return None
