"""Samples of the posterior: emcee's ensemble, moved as in the paper or by proposals from the fitted posterior.

The paper's stretch moves do for the pose alone. With levels and intrinsics beside it they need ten times as many steps;
the posterior is nearly Gaussian there, so that most steps propose from a wide copy of it (see `moves`).
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Final, Literal

import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field, NonNegativeInt, PositiveFloat

from linepose.arrays import Floats
from linepose.errors import EstimationError, InputError
from linepose.settings import Settings

if TYPE_CHECKING:  # configuration has these settings and must be read quickly: what samples is imported late
    import emcee

    from linepose.likelihood.base import Likelihood

_WARM_UPS: Final = 2
_OPEN_M, _OPEN_RAD = 0.02, 0.005  # where walkers start around an optimum whose curvature is of no use


class SamplingSettings(Settings):
    """The ensemble's size, length and start, moved as in the paper (whose numbers are the defaults).

    Examples
    --------
    >>> import linepose
    >>> linepose.SamplingSettings(n_steps=400).n_walkers
    250
    """

    section: ClassVar[Literal["sampling"]] = "sampling"
    n_walkers: int = Field(250, ge=4, description="Walkers of the ensemble.")
    n_burn_in: NonNegativeInt = Field(100, description="Steps thrown away.")
    n_steps: int = Field(100, ge=4, description="Steps kept.")
    stretch_scale: float = Field(2.5, gt=1, description="Scale a of the stretch move.")
    start_sigma_m: PositiveFloat = Field(0.1, description="Walkers start around the optimum with this sigma (m).")
    start_sigma_rad: PositiveFloat = Field(0.01, description="The same for the rotation vector (rad).")


class IndependenceSettings(Settings):
    """The ensemble's size and length for proposals from the fitted posterior, and the share of them among the moves.

    The rest are differential-evolution moves, which go on where the posterior is no Gaussian at all.

    Examples
    --------
    >>> import linepose
    >>> linepose.IndependenceSettings(n_steps=2000).independent_share
    0.9
    """

    section: ClassVar[Literal["independence_sampling"]] = "independence_sampling"
    n_walkers: int = Field(24, ge=24, description="Walkers of the ensemble, two a parameter or more.")
    n_burn_in: int = Field(160, ge=20, description="Steps that fit the proposals, thrown away.")
    n_steps: int = Field(1000, ge=4, description="Steps kept.")
    independent_share: float = Field(
        0.9, gt=0, lt=1, description="Share of proposals from the fit; the rest are differential evolution."
    )


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
    settings: SamplingSettings | IndependenceSettings | None = None,
    show_progress: bool = False,
) -> Chain:
    """Samples of the posterior, walkers started around the optimum (P,) (section 3.5); the settings choose the moves.

    The same seed gives the same samples on any number of cores: a step's proposals are drawn before they are evaluated.
    Raises InputError for fewer walkers than two a parameter.
    """
    import emcee

    settings = settings or SamplingSettings()
    if settings.n_walkers < 2 * likelihood.n_parameters:
        raise InputError(
            f"{settings.section}.n_walkers",
            f"{settings.n_walkers} walkers",
            f"at least {2 * likelihood.n_parameters}, two a parameter",
            "raise it",
        )
    random = np.random.RandomState(seed)
    centre = np.asarray(optimum, dtype=float)
    if isinstance(settings, IndependenceSettings):
        start, moves = _fitted_proposals(likelihood, centre, random, settings, show_progress)
    else:
        walker_sigma = likelihood.initial_walker_sigma(settings.start_sigma_m, settings.start_sigma_rad)
        start = centre + walker_sigma * random.standard_normal((settings.n_walkers, len(walker_sigma)))
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


def _fitted_proposals(
    likelihood: "Likelihood",
    optimum: Floats,
    random: np.random.RandomState,
    settings: IndependenceSettings,
    show_progress: bool,
) -> "tuple[Floats | emcee.State, list[tuple[Any, float]]]":
    """Walkers after the warm-up, and the moves that it taught: half from the curvature, half from what that drew.

    Where the curvature leaves a direction open, the first half goes by differential evolution alone.
    """
    import emcee

    from linepose.estimation.moves import independence_move
    from linepose.estimation.optimise import laplace_covariance

    share = settings.independent_share
    evolution = [(emcee.moves.DEMove(), 0.8 * (1 - share)), (emcee.moves.DESnookerMove(), 0.2 * (1 - share))]
    try:
        covariance = laplace_covariance(likelihood, optimum)
        moves = [(independence_move(optimum, covariance), share), *evolution]
    except EstimationError:
        covariance = np.diag(likelihood.initial_walker_sigma(_OPEN_M, _OPEN_RAD) ** 2)
        moves = [(emcee.moves.DEMove(), 0.8), (emcee.moves.DESnookerMove(), 0.2)]
    root = np.linalg.cholesky(covariance)
    state: Floats | emcee.State = optimum + random.standard_normal((settings.n_walkers, len(optimum))) @ root.T
    for _ in range(_WARM_UPS):
        sampler = _ensemble(likelihood, state, moves, random, settings.n_burn_in // _WARM_UPS, show_progress)
        state = sampler.get_last_sample()
        random.set_state(state.random_state)
        drawn = sampler.get_chain(discard=settings.n_burn_in // (2 * _WARM_UPS), flat=True)
        moves = [(independence_move(drawn.mean(axis=0), np.cov(drawn.T)), share), *evolution]
    return state, moves


def stage_seed(seed: int, *key: int) -> int:
    """A seed of its own for each stage or experiment, from the study's seed and whole numbers that name it."""
    return int(np.random.SeedSequence([seed, *key]).generate_state(1)[0])
