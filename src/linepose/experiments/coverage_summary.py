"""What a coverage study says: coverage with binomial intervals, root-mean-square errors, uniformity of ranks."""

from typing import Final

import numpy as np
import pandas as pd
import pyarrow as pa
from scipy.stats import binomtest, chisquare

from linepose.estimation.importance import TRUSTED_SHAPE
from linepose.experiments.coverage import CELL, N_RANKED, RANK_COLUMNS, TRUE_COLUMNS
from linepose.geometry.pose import POSE_COLUMNS
from linepose.tables import floats, optional_floats, texts, whole_numbers

NOMINAL: Final = (0.68, 0.95)
RMSE_COLUMNS: Final = tuple(f"rmse_{name}" for name in POSE_COLUMNS)
BIAS_COLUMNS: Final = tuple(f"bias_{name}" for name in POSE_COLUMNS)
RANK_P_COLUMNS: Final = tuple(f"rank_p_value_{name}" for name in POSE_COLUMNS)
N_BINS: Final = 20

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
        *floats("laplace_coverage_68", "laplace_coverage_95"),
        *optional_floats(*RMSE_COLUMNS, *BIAS_COLUMNS, *RANK_P_COLUMNS),
        *optional_floats("median_effective_sample_size", "untrusted_share"),
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


def coverage_curve(surveys: pd.DataFrame, nominal: np.ndarray, column: str = "credibility") -> pd.DataFrame:
    """One row a cell and nominal probability: how often that region held the truth, with a 95 % interval."""
    rows = []
    for cell, part in surveys.groupby(CELL, sort=False):
        for probability in nominal:
            held = int((part[column] < probability).sum())
            low, high = clopper_pearson(held, len(part))
            rows.append(
                dict(zip(CELL, cell, strict=True))
                | {"nominal": float(probability), "n_surveys": len(part), "n_covered": held}
                | {"coverage": held / len(part), "coverage_low": low, "coverage_high": high}
            )
    return pd.DataFrame(rows)


def coverage_summary(surveys: pd.DataFrame) -> pd.DataFrame:
    """One row a cell: coverage at 68 and 95 %, root-mean-square errors, biases in sigmas, uniformity of the ranks.

    Errors and ranks are of the estimates that did not fail; coverage counts a failed one as a miss.
    """
    rows = []
    for cell, part in surveys.groupby(CELL, sort=False):
        row = dict(zip(CELL, cell, strict=True)) | {"n_surveys": len(part), "n_failed": int(part["failed"].sum())}
        for name, column in (("", "credibility"), ("laplace_", "laplace_credibility")):
            for probability in NOMINAL:
                held = int((part[column] < probability).sum())
                key = f"{name}coverage_{round(100 * probability)}"
                row |= {key: held / len(part)}
                if not name:
                    row[f"{key}_low"], row[f"{key}_high"] = clopper_pearson(held, len(part))
        found = part[~part["failed"]]
        error = found[list(POSE_COLUMNS)].to_numpy() - found[list(TRUE_COLUMNS)].to_numpy()
        sigma = found[[f"sigma_{name}" for name in POSE_COLUMNS]].to_numpy()
        none = np.full(len(POSE_COLUMNS), np.nan)
        row |= dict(zip(RMSE_COLUMNS, np.sqrt(np.mean(error**2, axis=0)) if len(found) else none, strict=True))
        row |= dict(zip(BIAS_COLUMNS, np.mean(error / sigma, axis=0) if len(found) else none, strict=True))
        row |= {p: rank_p_value(found[rank]) for p, rank in zip(RANK_P_COLUMNS, RANK_COLUMNS, strict=True)}
        row["median_effective_sample_size"] = float(found["effective_sample_size"].median())
        row["untrusted_share"] = float((found["pareto_shape"] > TRUSTED_SHAPE).mean()) if len(found) else np.nan
        rows.append(row)
    return pd.DataFrame(rows)


def rank_histogram(ranks: pd.Series) -> np.ndarray:
    """How many ranks, 0 to `N_RANKED`, fall into each of `N_BINS` bins of equal size."""
    return np.bincount(ranks.to_numpy(dtype=int) * N_BINS // (N_RANKED + 1), minlength=N_BINS)


def rank_p_value(ranks: pd.Series) -> float:
    """Chance of a histogram at least as uneven where ranks are uniform (chi-square); NaN for fewer than five a bin."""
    counts = rank_histogram(ranks)
    return float(chisquare(counts).pvalue) if counts.sum() >= 5 * N_BINS else float("nan")
