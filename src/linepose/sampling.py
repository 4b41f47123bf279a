"""Samples of the pose's posterior: emcee's affine-invariant ensemble."""

from dataclasses import dataclass

import emcee
import numpy as np
from numpy.typing import ArrayLike

from linepose.errors import InputError
from linepose.likelihood.base import Likelihood
from linepose.rotations import Floats


@dataclass(frozen=True)
class SamplingSettings:
    """The ensemble's size, length and start (the paper's by default)."""

    n_walkers: int = 250
    n_burn_in: int = 100
    n_steps: int = 100
    stretch_scale: float = 2.5
    start_sigma_m: float = 0.1
    start_sigma_rad: float = 0.01


@dataclass(frozen=True)
class Chain:
    """Kept samples: parameters (steps, walkers, P), log_likelihood (steps, walkers), acceptance_fraction (walkers,)."""

    parameters: Floats
    log_likelihood: Floats
    acceptance_fraction: Floats

    def flat(self) -> Floats:
        """All samples (steps * walkers, P)."""
        return self.parameters.reshape(-1, self.parameters.shape[-1])

    def sigma(self) -> Floats:
        """One standard deviation of each parameter (P,)."""
        return self.flat().std(axis=0, ddof=1)

    def covariance(self) -> Floats:
        """Sample covariance (P, P)."""
        return np.cov(self.flat().T)


def sample(
    likelihood: Likelihood,
    optimum: ArrayLike,
    seed: int,
    settings: SamplingSettings | None = None,
    show_progress: bool = False,
) -> Chain:
    """Samples of the posterior, walkers started around the optimum (P,) (section 3.5).

    The same seed gives the same samples on any number of cores: a step's proposals are drawn before they are evaluated.
    Raises InputError for fewer walkers than two a parameter.
    """
    settings = settings or SamplingSettings()
    if settings.n_walkers < 2 * likelihood.n_parameters:
        raise InputError(
            "sampling.n_walkers",
            f"{settings.n_walkers} walkers",
            f"at least {2 * likelihood.n_parameters}, two a parameter",
            "raise it",
        )
    random = np.random.RandomState(seed)
    scatter = likelihood.scatter(settings.start_sigma_m, settings.start_sigma_rad)
    start = np.asarray(optimum, dtype=float) + scatter * random.standard_normal((settings.n_walkers, len(scatter)))
    sampler = emcee.EnsembleSampler(
        settings.n_walkers,
        likelihood.n_parameters,
        likelihood.log_likelihoods,
        moves=emcee.moves.StretchMove(a=settings.stretch_scale),
        vectorize=True,
    )
    sampler.random_state = random.get_state()
    state = sampler.run_mcmc(start, settings.n_burn_in, progress=show_progress) if settings.n_burn_in else start
    sampler.reset()
    sampler.run_mcmc(state, settings.n_steps, progress=show_progress)
    return Chain(
        parameters=sampler.get_chain(),
        log_likelihood=sampler.get_log_prob(),
        acceptance_fraction=sampler.acceptance_fraction,
    )


def stage_seed(seed: int, *key: int) -> int:
    """A seed of its own for each stage or experiment, from the study's seed and whole numbers that name it."""
    return int(np.random.SeedSequence([seed, *key]).generate_state(1)[0])
