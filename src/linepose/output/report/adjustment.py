"""The section on the adjustment: what the errors were, which reported sigmas look wrong, and whether halves agree."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from linepose.arrays import Floats
from linepose.experiments.adjustment_beside import ADJUSTMENT
from linepose.output.adjusted import Halves, halves, has_adjustment, is_adjusted, levels_by_set, set_in_words
from linepose.output.report.adjustment_on_page import halves_table, level_table, pose_table, sigma_table, view_table
from linepose.output.report.adjustment_words import FAULT_WORDS, boresight_sentence, levels_sentence, sigmas_sentence
from linepose.output.report.intrinsics import intrinsics_on_page, intrinsics_sentence
from linepose.output.report.known_target import knows_target, target_sentence, target_table
from linepose.output.report.sections import SectionOnPage
from linepose.pipeline.adjusted_schemas import MEASUREMENTS, VIEWS
from linepose.pipeline.calibration import INLIERS, Calibration
from linepose.pipeline.stages import DIAGNOSTICS
from linepose.pipeline.table_checks import stage_rows
from linepose.survey.observations import VARIANCE_COLUMNS


def adjustment_section(calibration: Calibration) -> SectionOnPage | None:
    """The section; None where a platform has no adjustment."""
    if not has_adjustment(calibration.platform_file):
        return None
    own = is_adjusted(calibration.platform_file)
    levels, found = levels_by_set(calibration), halves(calibration)
    views = with_least_weights(
        calibration.results.table("adjusted_views", VIEWS),
        calibration.results.table("adjusted_measurements", MEASUREMENTS),
    )
    first = next(iter(levels.values()))
    paragraphs = [
        halves_sentence(found),
        levels_sentence(first),
        sigmas_sentence(levels),
        boresight_sentence(first, _duration_s(calibration), _reported_rad(calibration)),
        views_sentence(views),
        target_sentence(calibration) if own and knows_target(calibration) else "",
        *_warnings(calibration),
    ]
    camera = calibration.intrinsics if own else None
    if camera is not None:
        paragraphs.insert(3, intrinsics_sentence(camera))
    anchor = f"{calibration.name}-adjustment"
    tables = [] if own else [pose_table(f"{anchor}-poses", calibration)]
    tables += [level_table(f"{anchor}-levels", levels), sigma_table(f"{anchor}-sigmas", levels)]
    tables += [] if camera is None else [intrinsics_on_page(f"{anchor}-camera", camera)]
    tables += [target_table(f"{anchor}-target", calibration)] if own and knows_target(calibration) else []
    tables += [halves_table(f"{anchor}-halves", found)] if found else []
    tables.append(view_table(f"{anchor}-views", views))
    title = "What the errors were" if own else "The adjustment"
    return SectionOnPage(anchor, title, "\n\n".join(filter(None, paragraphs)), tables)


def halves_sentence(found: Sequence[Halves]) -> str:
    """The headline: how many times as far apart as stated random halves lie, of each model and set."""
    if not found:
        return ""
    first, *others = found
    sentence = f"Random halves lie {first.factor:.2f} times as far apart as stated"
    if not others:
        return f"{sentence}."
    rest = ", ".join(f"{one.factor:.2f} times ({_of_halves(one)})" for one in others)
    return f"{sentence} ({_of_halves(first)}), {rest}."


def _of_halves(one: Halves) -> str:
    return f"{one.noise_model}, {set_in_words(one.set)}"


def with_least_weights(views: pd.DataFrame, measurements: pd.DataFrame) -> pd.DataFrame:
    """`VIEWS` with `least_weight`: of the observation or of the measurement in it that counts least."""
    of_measurements = views["observation"].map(measurements.groupby("observation")["weight"].min())
    return views.assign(least_weight=np.fmin(views["weight"], of_measurements))


def views_sentence(views: pd.DataFrame) -> str:
    """Which observations are far off, and what their errors look like; `views` as `with_least_weights` has them."""
    doubtful = views[views["fault"] != ""].sort_values("least_weight")
    if doubtful.empty:
        return "No observation is far off, and none was removed."
    named = "; ".join(
        f"{row['observation']}, weight {row['least_weight']:.2g}, {FAULT_WORDS[row['fault']]}"
        for _, row in doubtful.iterrows()
    )
    return f"Far off, but not removed: observation {named}."


def _duration_s(calibration: Calibration) -> float:
    time_us = calibration.results.table("adjusted_measurements", MEASUREMENTS)["time_us"].to_numpy()
    return float(1e-6 * np.ptp(time_us))


def _reported_rad(calibration: Calibration) -> Floats:
    """Typical reported sigmas of roll, pitch and yaw (3,)."""
    return np.sqrt(calibration.observations[list(VARIANCE_COLUMNS[3:])].to_numpy().mean(axis=0))


def _warnings(calibration: Calibration) -> list[str]:
    """What the adjustment warns of, a sentence a set of observations."""
    results = calibration.results
    if is_adjusted(calibration.platform_file):
        rows = stage_rows(results.table("diagnostics", DIAGNOSTICS), INLIERS, [], "diagnostics.parquet")
        told = {"": str(rows["warning"].iloc[0])}
    else:
        table = results.table("adjustment", ADJUSTMENT)
        told = {f" ({set_in_words(row['set'])})": str(row["warning"]) for _, row in table.iterrows()}
    return [f"Warning{place}: {warning}." for place, warning in told.items() if warning]
