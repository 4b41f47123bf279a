"""Whether a chain can be trusted: acceptance, autocorrelation, effective sample size, split R-hat."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from linepose.arrays import Floats

MAXIMUM_R_HAT: Final = 1.01
MINIMUM_STEPS_PER_TIME: Final = 50  # emcee's rule for a trustworthy autocorrelation time
MINIMUM_SAMPLES: Final = 2000  # effective ones: 1.6 % of a sigma in each sigma, 3 % of its width in an interval's end


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
    from arviz_stats.base import array_stats

    even = samples[: samples.shape[0] // 2 * 2]
    moved = even.var(axis=0).max(axis=0) > 0
    r_hat = np.full(samples.shape[-1], np.inf)
    if moved.any():
        r_hat[moved] = array_stats.rhat(even[..., moved], chain_axis=1, draw_axis=0, method="split")
    return r_hat


def diagnose_samples(samples: Floats) -> ChainDiagnostics:
    """Diagnostics of samples (S, W, P), with a warning that says what to do, empty where there is nothing to say.

    autocorrelation: it counts as no sample, and the warning says so.
    """
    n_steps, n_walkers, n_parameters = samples.shape
    moved = np.any(np.diff(samples, axis=0) != 0, axis=(0, 2))
    n_moved = int(moved.sum())
    time = np.full(n_parameters, float(n_steps))
    if n_moved:
        import emcee

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
    effective = n_steps * n_moved / time
    if effective.min() < MINIMUM_SAMPLES:
        needed = int(np.ceil(n_steps * MINIMUM_SAMPLES / max(effective.min(), 1.0)))
        warnings.append(
            f"{effective.min():.0f} effective samples are few, expected {MINIMUM_SAMPLES}: set sampling.n_steps to "
            f"{needed} or more"
        )
    if r_hat.max() > MAXIMUM_R_HAT:
        warnings.append(
            f"split R-hat {r_hat.max():.3f} is above {MAXIMUM_R_HAT}: the walkers have not mixed: "
            f"raise sampling.n_steps"
        )
    return ChainDiagnostics(
        acceptance_fraction=acceptance_fraction(samples),
        autocorrelation_time=time,
        effective_sample_size=effective,
        split_r_hat=r_hat,
        sigma=samples.reshape(-1, n_parameters).std(axis=0, ddof=1),
        warning="; ".join(warnings),
    )


def acceptance_fraction(samples: Floats) -> float:
    """Share of steps in which a walker moved; (S, W, P)."""
    return float(np.any(np.diff(samples, axis=0) != 0, axis=2).mean())
