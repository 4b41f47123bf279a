"""Proposals for emcee beyond its own: draws that do not depend on where a walker stands.

A posterior that is nearly Gaussian, as those of the noise models are at the optimum, is sampled an order of magnitude
faster by proposing from a wide copy of itself than by moving walkers along each other.
"""

import numpy as np
from emcee.moves import MHMove
from numpy.typing import ArrayLike
from scipy.stats import multivariate_t

from linepose.arrays import Floats
from linepose.errors import EstimationError

DEGREES_OF_FREEDOM = 8  # heavier tails than the posterior's, so that no walker gets stuck in them


def independence_move(mean: ArrayLike, covariance: ArrayLike) -> MHMove:
    """Metropolis-Hastings with proposals from a Student-t of fixed mean and covariance (Tierney 1994).

    mean (P,), covariance (P, P): of warm-up samples, or the optimum and its inverse curvature. Must not be adapted
    while samples are kept. Raises EstimationError for a covariance that is not positive definite.
    """
    centre, shape = np.asarray(mean, dtype=float), np.asarray(covariance, dtype=float)
    scale = np.sqrt(np.diagonal(shape))
    try:
        root = scale[:, None] * np.linalg.cholesky(shape / np.outer(scale, scale))
    except np.linalg.LinAlgError as error:
        raise EstimationError(
            "no proposals: the covariance of the samples is not positive definite; draw a longer warm-up"
        ) from error
    standard = multivariate_t(shape=np.eye(len(centre)), df=DEGREES_OF_FREEDOM)
    inverse = np.linalg.inv(root)

    def log_density(samples: Floats) -> Floats:
        return np.asarray(standard.logpdf((samples - centre) @ inverse.T)).reshape(len(samples))

    def propose(samples: Floats, random: np.random.RandomState) -> tuple[Floats, Floats]:
        normal = random.standard_normal(samples.shape)
        stretch = np.sqrt(DEGREES_OF_FREEDOM / random.chisquare(DEGREES_OF_FREEDOM, size=(len(samples), 1)))
        proposed = centre + normal * stretch @ root.T
        return proposed, log_density(samples) - log_density(proposed)

    return MHMove(propose)
