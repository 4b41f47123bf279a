"""What a coverage study says: coverage with binomial intervals, errors in metres and in sigmas, failures."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Final

import numpy as np
import pandas as pd
import pyarrow as pa
from scipy.stats import binomtest, chi2, kstest

from linepose.experiments.coverage import AXES, CELL, ERROR_COLUMNS, ERROR_SIGMA_COLUMNS
from linepose.tables import floats, optional_floats, texts, whole_numbers

NOMINAL: Final = (0.68, 0.95)
ALL_PLATFORMS: Final = "all"
RMSE_COLUMNS: Final = tuple(f"rmse_{axis}" for axis in AXES)
BIAS_COLUMNS: Final = tuple(f"bias_{axis}" for axis in AXES)

COVERAGE: Final = pa.schema(
    [
        *texts(*CELL),
        *floats("nominal"),
        *whole_numbers("n_surveys", "n_covered"),
        *floats("coverage", "coverage_low", "coverage_high"),
    ]
)
COVERAGE_SUMMARY: Final = pa.schema(
    [
        *texts(*CELL),
        *whole_numbers("n_surveys", "n_failed"),
        *floats(*(f"coverage_{p}{end}" for p in (68, 95) for end in ("", "_low", "_high"))),
        *floats("uniform_p_value"),
        *optional_floats("ratio", "rmse_position_m", "rmse_turn_rad", *RMSE_COLUMNS, *BIAS_COLUMNS),
        *optional_floats("heavy_tails_share", "smallest_eigenvalue"),
    ]
)


def clopper_pearson(successes: int, trials: int, confidence: float = 0.95) -> tuple[float, float]:
    """Exact (conservative) binomial interval of a rate; (NaN, NaN) without trials."""
    if trials == 0:
        return (float("nan"), float("nan"))
    interval = binomtest(successes, trials).proportion_ci(confidence, method="exact")
    return (float(interval.low), float(interval.high))


def stated_probabilities() -> np.ndarray:
    """Probabilities of the regions that a curve is drawn through, 68 and 95 % among them."""
    return np.unique(np.concatenate([np.arange(1, 20) / 20, NOMINAL]))


def coverage_curve(surveys: pd.DataFrame, nominal: np.ndarray) -> pd.DataFrame:
    """One row a cell and nominal probability: how often that region held the truth, with a 95 % interval."""
    rows = []
    for cell, part in surveys.groupby(CELL, sort=False):
        for probability in nominal:
            held, share, low, high = _held(part, probability)
            rows.append(
                dict(zip(CELL, cell, strict=True))
                | {"nominal": float(probability), "n_surveys": len(part), "n_covered": held}
                | {"coverage": share, "coverage_low": low, "coverage_high": high}
            )
    return pd.DataFrame(rows)


def coverage_summary(surveys: pd.DataFrame, pools: Mapping[str, Sequence[str]]) -> pd.DataFrame:
    """One row a cell, then one a pool of regimes and noise model, over all platforms and of the pool's name.

    Coverage and its uniformity count a failed estimate as a miss; errors are of the estimates that did not fail.
    `ratio` is the root mean square of the six errors in sigmas: 1 where sigmas are right. Errors in metres and radians
    of a pool are none, as platforms differ.
    """
    rows = [dict(zip(CELL, cell, strict=True)) | _judged(part) for cell, part in surveys.groupby(CELL, sort=False)]
    for pool, model, part in _pooled(surveys, pools):
        row = {"platform": ALL_PLATFORMS, "regime": pool, "noise_model": model} | _judged(part)
        rows.append(row | dict.fromkeys(("rmse_position_m", "rmse_turn_rad", *RMSE_COLUMNS), np.nan))
    return pd.DataFrame(rows)


def ratio_interval(n_surveys: int, confidence: float = 0.95) -> tuple[float, float]:
    """Where the ratio lies with this probability if sigmas are right and the six errors independent."""
    freedom = len(AXES) * n_surveys
    low, high = np.sqrt(chi2.ppf([(1 - confidence) / 2, (1 + confidence) / 2], freedom) / freedom)
    return float(low), float(high)


def _pooled(surveys: pd.DataFrame, pools: Mapping[str, Sequence[str]]) -> Iterator[tuple[str, str, pd.DataFrame]]:
    """Name, noise model and surveys of each pool of which a noise model has every regime."""
    for pool, regimes in pools.items():
        for model, part in surveys[surveys["regime"].isin(regimes)].groupby("noise_model", sort=False):
            if set(part["regime"]) == set(regimes):
                yield pool, str(model), part


def _judged(part: pd.DataFrame) -> dict[str, Any]:
    row: dict[str, Any] = {"n_surveys": len(part), "n_failed": int(part["failed"].sum())}
    for probability in NOMINAL:
        key = f"coverage_{round(100 * probability)}"
        _, row[key], row[f"{key}_low"], row[f"{key}_high"] = _held(part, probability)
    row["uniform_p_value"] = float(kstest(part["credibility"], "uniform").pvalue)
    found = part[~part["failed"]]
    if found.empty:
        return row | dict.fromkeys(COVERAGE_SUMMARY.names[len(CELL) + len(row) :], np.nan)
    error = found[list(ERROR_COLUMNS)].to_numpy()
    scaled = error / found[list(ERROR_SIGMA_COLUMNS)].to_numpy()
    mean_squares = np.mean(error**2, axis=0)
    return row | {
        "ratio": float(np.sqrt(np.mean(scaled**2))),
        "rmse_position_m": float(np.sqrt(mean_squares[:3].sum())),
        "rmse_turn_rad": float(np.sqrt(mean_squares[3:].sum())),
        **dict(zip(RMSE_COLUMNS, np.sqrt(mean_squares), strict=True)),
        **dict(zip(BIAS_COLUMNS, np.mean(scaled, axis=0), strict=True)),
        "heavy_tails_share": float(found["heavy_tails"].mean()),
        "smallest_eigenvalue": float(found["least_eigenvalue"].min()),
    }


def _held(part: pd.DataFrame, probability: float) -> tuple[int, float, float, float]:
    """How many surveys a region of this probability holds, their share, and its 95 % interval."""
    held = int((part["credibility"] < probability).sum())
    return held, held / len(part), *clopper_pearson(held, len(part))
