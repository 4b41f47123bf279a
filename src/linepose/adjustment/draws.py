"""Passes at many levels of one linear model, and what each says of the columns that are sought."""

from typing import NamedTuple

import numpy as np

from linepose.adjustment.levels import Levels
from linepose.adjustment.normal import Prior, one_pass, trailing_inverse
from linepose.adjustment.process import ErrorImage, ErrorStructure, Weights, components
from linepose.arrays import Floats
from linepose.compiling.kernels import kernel


class Drawn(NamedTuple):
    """Of D draws of the levels, the step from where the model is linear in the S last columns.

    deviance (D,): chi squared and log-determinant together, NaN where the normal equations are singular; mean (D, S)
    and covariance (D, S, S): normal at these levels, 0 and the identity where deviance is no finite number.
    """

    deviance: Floats
    mean: Floats
    covariance: Floats


@kernel
def passes_at(
    rows: Floats,
    structure: ErrorStructure,
    image: ErrorImage,
    weights: Weights,
    prior: Prior,
    log_levels: Floats,
    size: int,
) -> Drawn:
    """A pass of the columns (2 L, n) at each of the levels' logarithms (D, 7), for the last `size` columns."""
    count = log_levels.shape[0]
    deviance, mean, covariance = np.empty(count), np.zeros((count, size)), np.zeros((count, size, size))
    for draw in range(count):
        level = np.exp(log_levels[draw])
        levels = Levels(level[0], level[1], level[2], level[3], level[4], level[5], level[6])
        process = components(structure, image, levels, weights)
        done = one_pass(rows, process, structure.view_of, structure.begins, prior)
        deviance[draw] = done.chi_squared + done.log_determinant
        if not np.isfinite(deviance[draw]):
            for i in range(size):
                covariance[draw, i, i] = 1.0
            continue
        n = done.upper.shape[0] - 1
        inverse = trailing_inverse(done.upper, size)
        for k in range(size):
            vector = 0.0  # of the reduced normal equations
            for i in range(k + 1):
                vector += done.upper[n - size + i, n - size + k] * done.upper[n - size + i, n]
            for i in range(size):
                mean[draw, i] += inverse[i, k] * vector
        covariance[draw] = inverse
    return Drawn(deviance, mean, covariance)
