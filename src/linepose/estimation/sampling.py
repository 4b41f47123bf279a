"""Samples of a likelihood's posterior: emcee's ensemble, moved as in the paper."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, Self

import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field, PositiveFloat, model_validator

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.settings import Settings, SettingsError

if TYPE_CHECKING:  # configuration has these settings and must be read quickly: what samples is imported late
    import emcee

    from linepose.likelihood.base import Likelihood


MOST_WALKERS: Final = 10_000
MOST_STEPS: Final = 1_000_000
_MOST_SAMPLES: Final = 10_000_000  # kept and thrown away: less than 1 GB


class SamplingSettings(Settings):
    """The ensemble's size, length and start, moved as in the paper (whose numbers are the defaults).

    Examples
    --------
    >>> import linepose
    >>> linepose.SamplingSettings(n_steps=400).n_walkers
    250
    """

    n_walkers: int = Field(250, ge=4, le=MOST_WALKERS, description="Walkers of the ensemble.")
    n_burn_in: int = Field(100, ge=0, le=MOST_STEPS, description="Steps thrown away.")
    n_steps: int = Field(100, ge=4, le=MOST_STEPS, description="Steps kept.")
    stretch_scale: float = Field(2.5, gt=1, description="Scale a of the stretch move.")
    start_sigma_m: PositiveFloat = Field(0.1, description="Walkers start around the optimum with this sigma (m).")
    start_sigma_rad: PositiveFloat = Field(0.01, description="The same for the rotation vector (rad).")

    @model_validator(mode="after")
    def _fits_into_memory(self) -> Self:
        samples = self.n_walkers * max(self.n_steps, self.n_burn_in)
        if samples > _MOST_SAMPLES:
            expected = f"at most {_MOST_SAMPLES} samples, n_walkers times n_steps"
            raise SettingsError(f"{samples}", expected, "lower one of them")
        return self


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
    likelihood: "Likelihood",
    optimum: ArrayLike,
    seed: int,
    settings: SamplingSettings | None = None,
    show_progress: bool = False,
) -> Chain:
    """Samples of the posterior, walkers started around the optimum (P,) (section 3.5).

    The same seed gives the same samples on any number of cores: a step's proposals are drawn before they are evaluated.
    Raises InputError for fewer walkers than two a parameter.
    """
    import emcee

    settings = settings or SamplingSettings()
    if settings.n_walkers < 2 * likelihood.n_parameters:
        raise InputError(
            "sampling.n_walkers",
            f"{settings.n_walkers} walkers",
            f"at least {2 * likelihood.n_parameters}, two a parameter",
            "raise it",
        )
    random = np.random.RandomState(seed)
    centre = np.asarray(optimum, dtype=float)
    walker_sigma = likelihood.initial_walker_sigma(settings.start_sigma_m, settings.start_sigma_rad)
    start: Floats | emcee.State = centre + walker_sigma * random.standard_normal((settings.n_walkers, len(centre)))
    moves = emcee.moves.StretchMove(a=settings.stretch_scale)
    if settings.n_burn_in:
        start = _ensemble(likelihood, start, moves, random, settings.n_burn_in, show_progress).get_last_sample()
        random.set_state(start.random_state)
    sampler = _ensemble(likelihood, start, moves, random, settings.n_steps, show_progress)
    return Chain(
        parameters=sampler.get_chain(),
        log_likelihood=sampler.get_log_prob(),
        acceptance_fraction=sampler.acceptance_fraction,
    )


def _ensemble(
    likelihood: "Likelihood",
    start: "Floats | emcee.State",
    moves: Any,
    random: np.random.RandomState,
    n_steps: int,
    show_progress: bool,
) -> "emcee.EnsembleSampler":
    """An ensemble after its steps from the start (W, P)."""
    import emcee

    n_walkers = len(start.coords if isinstance(start, emcee.State) else start)
    sampler = emcee.EnsembleSampler(
        n_walkers, likelihood.n_parameters, likelihood.log_likelihoods, moves=moves, vectorize=True
    )
    sampler.random_state = random.get_state()
    sampler.run_mcmc(start, n_steps, progress=show_progress)
    return sampler


def stage_seed(seed: int, *key: int) -> int:
    """A seed of its own for each stage or experiment, from the study's seed and whole numbers that name it."""
    return int(np.random.SeedSequence([seed, *key]).generate_state(1)[0])
