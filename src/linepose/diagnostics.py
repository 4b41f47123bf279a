"""Whether a chain can be trusted: acceptance, autocorrelation, effective sample size, split R-hat."""

from dataclasses import dataclass
from typing import Final

import emcee
import numpy as np

from linepose.rotations import Floats
from linepose.sampling import Chain

MAXIMUM_R_HAT: Final = 1.01
MINIMUM_STEPS_PER_TIME: Final = 50  # emcee's rule for a trustworthy autocorrelation time


@dataclass(frozen=True)
class ChainDiagnostics:
    """Diagnostics of one chain of P parameters; autocorrelation time in steps."""

    acceptance_fraction: float
    autocorrelation_time: Floats
    effective_sample_size: Floats
    split_r_hat: Floats
    warning: str


def split_r_hat(samples: Floats) -> Floats:
    """Potential scale reduction of each parameter, every walker's chain split in two; (S, W, P) to (P,).

    Gelman et al., Bayesian Data Analysis, 3rd edition, section 11.4.
    """
    half = samples.shape[0] // 2
    chains = np.concatenate([samples[:half], samples[half : 2 * half]], axis=1)
    within = chains.var(axis=0, ddof=1).mean(axis=0)
    between = half * chains.mean(axis=0).var(axis=0, ddof=1)
    return np.sqrt(((half - 1) / half * within + between / half) / within)


def diagnose_chain(chain: Chain) -> ChainDiagnostics:
    """Diagnostics of a chain, with a warning that says what to do, empty where there is nothing to say."""
    n_steps, n_walkers, _ = chain.parameters.shape
    time = np.maximum(emcee.autocorr.integrated_time(chain.parameters, tol=0, quiet=True), 1.0)
    r_hat = split_r_hat(chain.parameters)
    warnings = []
    needed = int(np.ceil(MINIMUM_STEPS_PER_TIME * time.max()))
    if n_steps < needed:
        warnings.append(
            f"chain of {n_steps} steps is short for an autocorrelation time of {time.max():.0f}: "
            f"set sampling.n_steps to {needed} or more"
        )
    if r_hat.max() > MAXIMUM_R_HAT:
        warnings.append(f"split R-hat {r_hat.max():.3f} is above {MAXIMUM_R_HAT}: the walkers have not mixed")
    return ChainDiagnostics(
        acceptance_fraction=float(chain.acceptance_fraction.mean()),
        autocorrelation_time=time,
        effective_sample_size=n_steps * n_walkers / time,
        split_r_hat=r_hat,
        warning="; ".join(warnings),
    )
