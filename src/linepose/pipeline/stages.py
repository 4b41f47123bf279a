"""The estimate at each stage of the outlier removal: optimum, samples, diagnostics, and the table of poses."""

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np
import pandas as pd
import pyarrow as pa
from numpy.typing import ArrayLike

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.estimation.diagnostics import ChainDiagnostics
from linepose.estimation.optimise import Search, laplace_covariance, optimise
from linepose.estimation.sampling import Chain
from linepose.geometry.pose import N_PARAMETERS, POSE_COLUMNS, SIGMA_COLUMNS
from linepose.likelihood.base import Likelihood
from linepose.tables import flags, floats, optional_floats, texts, whole_numbers

LAPLACE_SIGMA_COLUMNS: Final = tuple(f"laplace_{name}" for name in SIGMA_COLUMNS)
OPTIMA: Final = pa.schema(
    [
        *texts("stage"),
        *whole_numbers("n_observations"),
        *floats(*POSE_COLUMNS, *LAPLACE_SIGMA_COLUMNS, "neg_log_likelihood"),
        *optional_floats("start_neg_log_likelihood"),
        *floats("reduced_chi_square"),
        *whole_numbers("n_evaluations", "degrees_of_freedom"),
        *flags("converged"),
    ]
)
SAMPLES: Final = pa.schema([*whole_numbers("walker", "step"), *floats(*POSE_COLUMNS, "log_likelihood")])
DIAGNOSTICS: Final = pa.schema(
    [
        *texts("stage"),
        *whole_numbers("n_observations"),
        *texts("parameter"),
        *floats(
            "acceptance_fraction",
            "autocorrelation_time",
            "effective_sample_size",
            "split_r_hat",
            "sampled_sigma",
            "laplace_sigma",
            "neg_log_likelihood",
            "reduced_chi_square",
        ),
        *optional_floats("pareto_shape", "least_eigenvalue", "disagreement_sigmas"),
        *optional_floats("sigma_without_target", "target_misfit_sigmas"),
        *texts("warning"),
    ]
)
POSE: Final = pa.schema(
    [
        *texts("stage"),
        *whole_numbers("n_observations"),
        *floats(*POSE_COLUMNS, *SIGMA_COLUMNS),
        *optional_floats("neg_log_likelihood"),
        *whole_numbers("n_evaluations"),
    ]
)


def laplace_sigma_columns(names: Sequence[str]) -> tuple[str, ...]:
    """Columns of the curvature's sigmas of these parameters."""
    return tuple(f"laplace_sigma_{name}" for name in names)


def optimise_stages(
    likelihood: Likelihood, stages: Mapping[str, Sequence[int]], start: ArrayLike, search: Search
) -> pd.DataFrame:
    """The optimum of each stage from the start pose (6,), with the sigmas of the Laplace approximation.

    Columns as in `OPTIMA`. The reduced chi-square is the likelihood's over its degrees of freedom: near one where the
    sigmas are right.
    """
    rows = []
    for name, numbers in stages.items():
        selected = likelihood.select(numbers)
        optimum = optimise(selected, start, search)
        sigma = np.sqrt(np.diag(laplace_covariance(selected, optimum.parameters)))
        chi_square, freedom = selected.chi_square(optimum.parameters)
        rows.append(
            {
                "stage": name,
                "n_observations": len(numbers),
                **dict(zip(likelihood.parameter_names, optimum.parameters, strict=True)),
                **dict(zip(laplace_sigma_columns(likelihood.parameter_names), sigma, strict=True)),
                "neg_log_likelihood": optimum.neg_log_likelihood,
                "start_neg_log_likelihood": -selected.log_likelihood(likelihood.start(start)),
                "reduced_chi_square": chi_square / freedom,
                "n_evaluations": optimum.n_evaluations,
                "degrees_of_freedom": freedom,
                "converged": optimum.converged,
            }
        )
    return pd.DataFrame(rows)


def sample_table(chain: Chain, names: Sequence[str]) -> pd.DataFrame:
    """One row a kept sample, ordered by step and walker."""
    n_steps, n_walkers, _ = chain.parameters.shape
    step, walker = np.divmod(np.arange(n_steps * n_walkers), n_walkers)
    columns = {"walker": walker, "step": step, **dict(zip(names, chain.flat().T, strict=True))}
    return pd.DataFrame({**columns, "log_likelihood": chain.log_likelihood.ravel()})


def samples_from_table(table: pd.DataFrame, names: Sequence[str]) -> Floats:
    """Samples (steps, walkers, P) of a table that `sample_table` made; raises InputError where rows are missing."""
    ordered = table.sort_values(["step", "walker"])
    n_steps, n_walkers = int(table["step"].max()) + 1, int(table["walker"].max()) + 1
    if len(table) != n_steps * n_walkers:
        expected = f"{n_steps} steps of {n_walkers} walkers"
        raise InputError("samples", f"{len(table)} rows", expected, "run its stage again")
    return ordered[list(names)].to_numpy().reshape(n_steps, n_walkers, len(names))


def estimated_parameters(optima: pd.DataFrame) -> list[str]:
    """Names of the parameters that a table of `optimise_stages` has, the pose's first."""
    return [name for name in optima.columns if set(laplace_sigma_columns([name])) <= set(optima.columns)]


def diagnostics_table(optima: pd.DataFrame, diagnostics: Mapping[str, ChainDiagnostics]) -> pd.DataFrame:
    """One row a parameter and stage: is the chain long enough, and do sampled and Laplace sigma agree.

    Columns as in `DIAGNOSTICS`.
    """
    rows = []
    for _, optimum in optima.iterrows():
        chain = diagnostics[optimum["stage"]]
        for i, name in enumerate(estimated_parameters(optima)):
            rows.append(
                {
                    "stage": optimum["stage"],
                    "n_observations": optimum["n_observations"],
                    "parameter": name,
                    "acceptance_fraction": chain.acceptance_fraction,
                    "autocorrelation_time": chain.autocorrelation_time[i],
                    "effective_sample_size": chain.effective_sample_size[i],
                    "split_r_hat": chain.split_r_hat[i],
                    "sampled_sigma": chain.sigma[i],
                    "laplace_sigma": optimum[laplace_sigma_columns([name])[0]],
                    "neg_log_likelihood": optimum["neg_log_likelihood"],
                    "reduced_chi_square": optimum["reduced_chi_square"],
                    "pareto_shape": np.nan,
                    "least_eigenvalue": np.nan,
                    "disagreement_sigmas": np.nan,
                    "sigma_without_target": np.nan,
                    "target_misfit_sigmas": np.nan,
                    "warning": chain.warning,
                }
            )
    return pd.DataFrame(rows)


def pose_table(
    optima: pd.DataFrame,
    sampled_sigma: Mapping[str, Floats],
    start: ArrayLike,
    start_sigma: ArrayLike,
) -> pd.DataFrame:
    """The poses that people ask for: the hand-measured one, then each stage's optimum with its sampled sigma.

    `start` and `start_sigma` (6,) are the hand measurement; its -log L is that of the inliers.
    Columns as in `POSE`.
    """
    inliers = optima.loc[optima["stage"] == "inliers"].iloc[0]
    hand = {
        "stage": "hand_measured",
        "n_observations": inliers["n_observations"],
        **dict(zip(POSE_COLUMNS, np.asarray(start, dtype=float), strict=True)),
        **dict(zip(SIGMA_COLUMNS, np.asarray(start_sigma, dtype=float), strict=True)),
        "neg_log_likelihood": inliers["start_neg_log_likelihood"],
        "n_evaluations": 1,
    }
    rows = [hand]
    for _, optimum in optima.iterrows():
        kept = {
            name: optimum[name]
            for name in ("stage", "n_observations", *POSE_COLUMNS, "neg_log_likelihood", "n_evaluations")
        }
        rows.append(kept | dict(zip(SIGMA_COLUMNS, sampled_sigma[optimum["stage"]][:N_PARAMETERS], strict=True)))
    return pd.DataFrame(rows)
