"""Whether a chain can be trusted: acceptance, autocorrelation, effective sample size, split R-hat."""

from dataclasses import dataclass
from typing import Final

import emcee
import numpy as np

from linepose.rotations import Floats

MAXIMUM_R_HAT: Final = 1.01
MINIMUM_STEPS_PER_TIME: Final = 50  # emcee's rule for a trustworthy autocorrelation time


@dataclass(frozen=True)
class ChainDiagnostics:
    """Diagnostics of one chain of P parameters; autocorrelation time in steps, sigma in the parameters' units."""

    acceptance_fraction: float
    autocorrelation_time: Floats
    effective_sample_size: Floats
    split_r_hat: Floats
    sigma: Floats
    warning: str


def split_r_hat(samples: Floats) -> Floats:
    """Potential scale reduction of each parameter, every walker's chain split in two; (S, W, P) to (P,).

    Infinite where no walker moved.

    Gelman et al., Bayesian Data Analysis, 3rd edition, section 11.4.
    """
    half = samples.shape[0] // 2
    chains = np.concatenate([samples[:half], samples[half : 2 * half]], axis=1)
    within = chains.var(axis=0, ddof=1).mean(axis=0)
    between = half * chains.mean(axis=0).var(axis=0, ddof=1)
    ratio = np.divide(between / half, within, out=np.full_like(within, np.inf), where=within > 0)
    return np.sqrt((half - 1) / half + ratio)


def diagnose_samples(samples: Floats) -> ChainDiagnostics:
    """Diagnostics of samples (S, W, P), with a warning that says what to do, empty where there is nothing to say.

    A walker that never moved has no autocorrelation: it counts as no sample, and the warning says so.
    """
    n_steps, n_walkers, n_parameters = samples.shape
    moved = np.any(np.diff(samples, axis=0) != 0, axis=(0, 2))
    n_moved = int(moved.sum())
    time = np.full(n_parameters, float(n_steps))
    if n_moved:
        time = np.maximum(emcee.autocorr.integrated_time(samples[:, moved], tol=0, quiet=True), 1.0)
    r_hat = split_r_hat(samples)
    warnings = []
    if n_moved < n_walkers:
        warnings.append(
            f"{n_walkers - n_moved} of {n_walkers} walkers never moved: raise sampling.n_burn_in and sampling.n_steps"
        )
    needed = int(np.ceil(MINIMUM_STEPS_PER_TIME * time.max()))
    if n_steps < needed:
        warnings.append(
            f"chain of {n_steps} steps is short for an autocorrelation time of {time.max():.0f}: "
            f"set sampling.n_steps to {needed} or more"
        )
    if r_hat.max() > MAXIMUM_R_HAT:
        warnings.append(f"split R-hat {r_hat.max():.3f} is above {MAXIMUM_R_HAT}: the walkers have not mixed")
    return ChainDiagnostics(
        acceptance_fraction=acceptance_fraction(samples),
        autocorrelation_time=time,
        effective_sample_size=n_steps * n_moved / time,
        split_r_hat=r_hat,
        sigma=samples.reshape(-1, n_parameters).std(axis=0, ddof=1),
        warning="; ".join(warnings),
    )


def acceptance_fraction(samples: Floats) -> float:
    """Share of steps in which a walker moved; (S, W, P)."""
    return float(np.any(np.diff(samples, axis=0) != 0, axis=2).mean())
