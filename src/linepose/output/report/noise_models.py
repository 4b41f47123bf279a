"""The noise models side by side: which to use and why, in this run's own numbers."""

from typing import Final

import numpy as np
import pandas as pd
from scipy.stats import chi

from linepose.errors import InputError
from linepose.estimation.noise_models import BALANCED, PUBLISHED, ROBUST, SHARED
from linepose.experiments.consistency import CONSISTENCY_SUMMARY
from linepose.experiments.noise_models import ALL, IDENTIFIABILITY, INLIERS, NOISE_MODELS
from linepose.experiments.noise_models import SECTION as NOISE_MODELS_SECTION
from linepose.geometry.pose import N_PARAMETERS, POSE_COLUMNS, SIGMA_COLUMNS
from linepose.output.report.sections import SectionOnPage, TableOnPage
from linepose.pipeline.calibration import Calibration

_POSE_HEADS: Final = ("r_x (m)", "r_y (m)", "r_z (m)", "theta e_x (rad)", "theta e_y (rad)", "theta e_z (rad)")
_LEVELS: Final = ("shared_level", "white_level", "pixel_level")
_CLOSE: Final = 0.68  # content of the region around the shared estimate, within which the balanced one says the same
_FAR: Final = 0.999  # content of the region around the shared estimate, beyond which the robust one is another pose
_WELL_MATCHED: Final = (0.8, 1.25)  # factors on the sigmas that are no reason to change them


def noise_models_section(calibration: Calibration) -> SectionOnPage | None:
    """The section of a platform whose file asks for the experiment, None otherwise."""
    if not NOISE_MODELS_SECTION.of(calibration.platform_file):
        return None
    estimates = calibration.results.table("noise_models", NOISE_MODELS)
    summary = calibration.results.table("consistency_summary", CONSISTENCY_SUMMARY)
    identified = calibration.results.table("identifiability", IDENTIFIABILITY)
    anchor = f"{calibration.name}-noise-models"
    tables = [
        pose_table(f"{anchor}-poses", estimates),
        level_table(f"{anchor}-levels", estimates),
        consistency_table(f"{anchor}-consistency", summary),
        identifiability_table(f"{anchor}-identifiability", identified),
    ]
    if estimates["error_in_sigmas"].notna().all():
        tables.insert(1, truth_table(f"{anchor}-truth", estimates))
    return SectionOnPage(anchor, "Which noise model?", paragraph(estimates, summary, identified), tables)


def paragraph(estimates: pd.DataFrame, summary: pd.DataFrame, identified: pd.DataFrame) -> str:
    """Which model to use and why, and what speaks against it."""
    shared, published = _estimate(estimates, SHARED.name, INLIERS), _estimate(estimates, PUBLISHED.name, INLIERS)
    factor = {model: _halves_factor(summary, model) for model in (PUBLISHED.name, SHARED.name)}
    sentences = [
        "The published model takes each line of a view to have a navigation error of its own; the shared model takes "
        "most of it to be common to the view and infers how much: here "
        f"{shared['shared_level']:.2f} of the reported sigmas is shared and {shared['white_level']:.2g} is each line's "
        f"own, with {shared['pixel_level']:.1f} times the stated pixel noise."
    ]
    if np.isfinite(factor[PUBLISHED.name]) and np.isfinite(factor[SHARED.name]):
        sentences.append(
            "Random halves of the accepted observations lie "
            f"{factor[PUBLISHED.name]:.2f} times as far apart as the published model's sigmas promise, and "
            f"{factor[SHARED.name]:.2f} times under the shared model."
        )
        sentences.append(_sigmas_of_shared(factor[PUBLISHED.name], factor[SHARED.name]))
    moved = (shared[list(POSE_COLUMNS)] - published[list(POSE_COLUMNS)]).to_numpy(dtype=float)
    in_sigmas = np.abs(moved / shared[list(SIGMA_COLUMNS)].to_numpy(dtype=float))
    most = int(np.argmax(in_sigmas))
    sentences.append(
        f"It moves the pose of the accepted observations by {1e3 * np.linalg.norm(moved[:3]):.0f} mm, most in sigmas "
        f"in {_POSE_HEADS[most].split(' (')[0]} ({in_sigmas[most]:.1f})."
    )
    if np.isfinite(shared["error_in_sigmas"]):
        sentences.append(_truth_sentence(estimates))
    balanced = _estimate(estimates, BALANCED.name, INLIERS)
    sentences.append(
        "Use the balanced model, in which distance alone explains no error better. It lies "
        f"{balanced['mahalanobis']:.1f} sigmas from the shared one: {_balanced_advice(float(balanced['mahalanobis']))}"
    )
    robust = _estimate(estimates, ROBUST.name, ALL)
    sentences.append(
        f"The robust model with all {int(robust['n_observations'])} observations in lies {robust['mahalanobis']:.1f} "
        f"sigmas (six degrees of freedom, median {chi.median(N_PARAMETERS):.1f}) from the shared model's accepted "
        f"ones: {_robust_advice(float(robust['mahalanobis']))}"
    )
    sentences.append(f"The data say least of {identified['weakest_in_words'].iloc[0]}.")
    return " ".join(sentences)


def _estimate(estimates: pd.DataFrame, noise_model: str, name: str) -> pd.Series:
    """The row of a model and a set; raises InputError where there is none."""
    rows = estimates[(estimates["noise_model"] == noise_model) & (estimates["set"] == name)]
    if rows.empty:
        raise InputError(
            "noise_models.parquet", f"no row of {noise_model}, {name}", "an estimate of it", "run its stage again"
        )
    return rows.iloc[0]


def _balanced_advice(distance: float) -> str:
    if distance < chi.ppf(_CLOSE, N_PARAMETERS):
        return "they say the same."
    return "the shared model rewards distance where errors differ from line to line."


def _robust_advice(distance: float) -> str:
    if distance < chi.ppf(_FAR, N_PARAMETERS):
        return "use it where the removal of observations is not to be trusted."
    return "too far to be the same pose. Its weights name the bad views, its pose is not to be used here."


def _halves_factor(summary: pd.DataFrame, model: str) -> float:
    """What the sigmas of a model want to be multiplied by, after random halves of the platform's own observations."""
    rows = summary[(summary["noise_model"] == model) & summary["comparison"].str.startswith("random halves")]
    return float(rows["sigma_factor"].iloc[0]) if len(rows) else float("nan")


def _sigmas_of_shared(published: float, shared: float) -> str:
    """How far the shared model's sigmas hold, after these factors on the sigmas of either."""
    low, high = _WELL_MATCHED
    if low <= shared <= high:
        return "The shared model's sigmas hold as they stand."
    if abs(np.log(shared)) < abs(np.log(published)):
        word = "small" if shared > 1 else "large"
        return f"The shared model's sigmas are the nearer to the truth, though too {word} by the factor above."
    word = "too small" if shared > 1 else "larger than these halves need"
    return (
        f"On these observations the shared model's sigmas are {word} by the factor above, further off than the "
        "published ones: the errors here are not of the kind that it is made for, so compare both poses before you "
        "rely on either."
    )


def _truth_sentence(estimates: pd.DataFrame) -> str:
    told = []
    for model, name, words in (
        (PUBLISHED.name, INLIERS, "the published model after removal"),
        (SHARED.name, INLIERS, "the shared model after removal"),
        (BALANCED.name, INLIERS, "the balanced model after removal"),
        (ROBUST.name, ALL, "the robust model with every fault left in"),
    ):
        row = _estimate(estimates, model, name)
        told.append(f"{1e3 * row['position_error_m']:.0f} mm, {row['error_in_sigmas']:.1f} sigmas by {words}")
    return f"Against the truth of the simulation the error is {', '.join(told)}."


def pose_table(anchor: str, estimates: pd.DataFrame) -> TableOnPage:
    """The pose under each model from each set, with sampled sigmas."""
    rows = [
        [
            f"{row['noise_model']}, {_set_name(row['set'])}",
            str(row["n_observations"]),
            *(f"{row[name]:.3f} ± {row[sigma]:.3f}" for name, sigma in zip(POSE_COLUMNS, SIGMA_COLUMNS, strict=True)),
            f"{row['mahalanobis']:.1f}",
        ]
        for _, row in estimates.iterrows()
    ]
    heads = ["Noise model, observations", "Number", *_POSE_HEADS, "Apart (sigmas)"]
    sentence = "apart is the distance to the shared model's accepted observations, in sigmas of those"
    return TableOnPage(anchor, "Pose under each noise model", sentence, heads, rows, folded=False)


def truth_table(anchor: str, estimates: pd.DataFrame) -> TableOnPage:
    """Errors against the truth of a simulated platform with planted faults."""
    rows = [
        [
            f"{row['noise_model']}, {_set_name(row['set'])}",
            f"{1e3 * row['position_error_m']:.1f}",
            f"{np.degrees(row['rotation_error_rad']):.3f}",
            f"{row['error_in_sigmas']:.1f}",
        ]
        for _, row in estimates.iterrows()
    ]
    heads = ["Noise model, observations", "Position (mm)", "Rotation (°)", "Whole pose (sigmas)"]
    sentence = "inliers are what the outlier removal left, all has every planted fault in it"
    return TableOnPage(anchor, "Error against the truth", sentence, heads, rows)


def level_table(anchor: str, estimates: pd.DataFrame) -> TableOnPage:
    """The inferred levels with their 68 % intervals."""
    rows = [
        [
            f"{row['noise_model']}, {_set_name(row['set'])}",
            *(f"{row[one]:.3g} ({row[f'{one}_low']:.3g} to {row[f'{one}_high']:.3g})" for one in _LEVELS),
            f"{row['effective_sample_size']:.0f}",
            f"{row['split_r_hat']:.3f}",
        ]
        for _, row in estimates[estimates["noise_model"] != PUBLISHED.name].iterrows()
    ]
    heads = [
        "Noise model, observations",
        "a, shared",
        "b, of a line",
        "g, pixel",
        "Effective samples",
        "Split R-hat",
    ]
    sentence = "times the stated sigmas: median and central 68 %"
    return TableOnPage(anchor, "Inferred levels", sentence, heads, rows)


def consistency_table(anchor: str, summary: pd.DataFrame) -> TableOnPage:
    """Distances between disjoint observations beside those of right sigmas."""
    rows = [
        [
            f"{row['noise_model']}, {row['comparison']}",
            str(row["n_splits"]),
            f"{row['median_distance']:.2f}",
            f"{row['sigma_factor']:.2f}",
            f"{100 * row['share_beyond_68']:.0f} %" if row["n_splits"] > 1 else "",
            f"{100 * row['share_beyond_95']:.0f} %" if row["n_splits"] > 1 else "",
        ]
        for _, row in summary.iterrows()
    ]
    heads = ["Noise model, pairs", "Number", "Median (sigmas)", "Factor", "Beyond 68 %", "Beyond 95 %"]
    sentence = f"right sigmas give a median of {chi.median(N_PARAMETERS):.2f}, 32 % and 5 %"
    return TableOnPage(anchor, "Agreement of disjoint observations", sentence, heads, rows)


def identifiability_table(anchor: str, identified: pd.DataFrame) -> TableOnPage:
    """Prior against posterior of each parameter."""
    rows = [
        [
            str(row["parameter"]).replace("_", " "),
            f"{row['prior_sigma']:.3g}",
            f"{row['posterior_sigma']:.3g}",
            f"{row['shrinkage']:.3f}",
            f"{row['weakest_direction']:+.2f}",
        ]
        for _, row in identified.iterrows()
    ]
    heads = ["Parameter", "Prior sigma", "Posterior sigma", "Shrinkage", "Weakest direction"]
    sentence = "shrinkage of the variance, 1 where the data decide; the pose's prior is the hand measurement"
    return TableOnPage(anchor, "What the data say of each parameter", sentence, heads, rows)


def _set_name(name: str) -> str:
    return str(name).replace("_", " ")
