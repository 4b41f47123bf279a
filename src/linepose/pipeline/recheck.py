"""New views against a calibration: whether it holds, how far the camera has moved, what the views could have seen."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

import numpy as np
import pandas as pd

from linepose.adjustment.result import Adjustment, warnings_of
from linepose.adjustment.settings import AdjustmentSection
from linepose.config.platform import Platform
from linepose.config.study import Study
from linepose.errors import EstimationError, InputError
from linepose.estimation.adjustment_estimator import adjustment_estimator
from linepose.estimation.estimator import Conditions
from linepose.estimation.noise_models import ADJUSTMENT
from linepose.estimation.pose_change import FALSE_ALARMS, GROUPS, MOVES, PER_MOVE, POWER, WHOLE, PoseChange
from linepose.estimation.recheck import recheck as compare_views
from linepose.geometry.distance import mahalanobis_distance
from linepose.inputs.source import ScansSection
from linepose.pipeline.calibration import Calibration
from linepose.pipeline.known_points import known_of_platform, known_of_survey
from linepose.pipeline.load import read_observations
from linepose.pipeline.project_folder import find_project, load_platform_project
from linepose.survey.observations import survey_from_table
from linepose.survey.point_knowledge import KNOWN_POINTS, PointKnowledge, knowledge_from_table

VERSION: Final = 1
_SAME_SIGMAS: Final = 0.1  # by which the calibration may differ from what its observations say now


@dataclass(frozen=True, eq=False)
class Recheck:
    """What new views say of a calibration; what `recheck_platform` returns.

    `holds` says whether the views agree with the calibration, `sees` whether they could have seen any move at all.

    Parameters
    ----------
    name : str
        Of the platform.
    n_calibrated, n_views : int
        Observations that the calibration rests on, and new ones.
    change : PoseChange
        The move (m, and rad about body axes) with its information.
    false_alarms : float
        How often a camera that has not moved is told to have.
    warnings : tuple of str
        Why the numbers may not be trusted, one line each.

    Examples
    --------
    The views of the calibration itself are none to check it by:

    >>> linepose.calibrate_platform("myrobot").write("results/myrobot")
    >>> try:
    ...     recheck = linepose.recheck_platform("myrobot", "data/myrobot")
    ... except linepose.InputError as error:
    ...     print(error.remedy)
    leave these views out of the folder
    """

    name: str
    n_calibrated: int
    n_views: int
    change: PoseChange
    false_alarms: float
    warnings: tuple[str, ...]

    @property
    def holds(self) -> bool:
        """Whether the views agree with the calibration, by the test of all six numbers; not where they see nothing."""
        return self.sees and self.change.test(WHOLE).p_value >= self.false_alarms

    @property
    def sees(self) -> bool:
        """Whether the views could have seen any move at all."""
        return self.change.test(WHOLE).degrees_of_freedom > 0

    def table(self) -> pd.DataFrame:
        """One row a number of the move: `move`, `sigma`, `least_seen`, in m and degrees; infinite what is not seen."""
        change = self.change
        values = {"move": change.move, "sigma": change.sigma, "least_seen": change.least_seen(self.false_alarms)}
        return pd.DataFrame({name: value * PER_MOVE for name, value in values.items()}, index=list(MOVES))

    def as_dict(self) -> dict[str, Any]:
        """All of it as JSON holds it: numbers by name with their units, None for infinite ones."""
        rows = {
            move: {name: float(value) if np.isfinite(value) else None for name, value in row.items()}
            for move, row in self.table().iterrows()
        }
        tests = {group: self.change.test(group) for group in GROUPS}
        return {
            "format": "linepose recheck",
            "version": VERSION,
            "platform": self.name,
            "holds": self.holds,
            "sees": self.sees,
            "false_alarms": self.false_alarms,
            "power": POWER,
            "n_observations": {"calibration": self.n_calibrated, "views": self.n_views},
            "moves": rows,
            "tests": {
                group: {
                    "sigmas": one.distance,
                    "degrees_of_freedom": one.degrees_of_freedom,
                    "p_value": one.p_value,
                }
                for group, one in tests.items()
            },
            "warnings": list(self.warnings),
        }


def recheck(
    calibration: Calibration,
    observations: pd.DataFrame,
    adjustment: AdjustmentSection | None = None,
    *,
    known_points: Mapping[str, PointKnowledge] | None = None,
    seed: int | None = None,
    false_alarms: float = FALSE_ALARMS,
) -> Recheck:
    """Whether a calibration still holds, by new views of any pattern.

    Parameters
    ----------
    calibration : Calibration
        Made by the adjustment, which removes no observation.
    observations : pandas.DataFrame
        Those of the new views, as `load_observations` makes them.
    adjustment : AdjustmentSection, optional
        How the calibration was adjusted.
    known_points : mapping of str to PointKnowledge, optional
        What is known of the points of the new views, by their names.
    seed : int, optional
        The seed that the calibration was made with.
    false_alarms : float, optional
        How often a camera that has not moved may be told to have.

    Returns
    -------
    Recheck
        The move with its sigma, p-values, and the least move that the views could have seen.

    Raises
    ------
    InputError
        The observations cannot be used, or the calibration is of another noise model or of other settings.
    EstimationError
        The views lead to no estimate.
    """
    _check(calibration, observations, false_alarms)
    section = adjustment or AdjustmentSection()
    own_seed = int(Study.model_fields["seed"].default) if seed is None else seed
    calibrated = _adjusted_again(calibration, section, own_seed)
    survey = survey_from_table(observations)
    known = known_of_survey(known_points or {}, survey)
    found = compare_views(calibrated, survey, calibration.camera, section, known, own_seed)
    told = found.views.diagnostics
    if not told.converged:
        raise EstimationError(
            f"recheck of {calibration.name}: the adjustment of the {survey.n_observations} new views has not converged;"
            " add views from other sides, or correct wrong labels among them"
        )
    prior_aside = replace(told, disagreement_sigmas=np.full(6, np.nan), open_directions=())
    return Recheck(
        calibration.name,
        calibration.n_observations,
        survey.n_observations,
        found.change,
        false_alarms,
        warnings_of(prior_aside),
    )


def recheck_platform(
    platform: str, data: Path | str, project: Path | str = ".", *, false_alarms: float = FALSE_ALARMS
) -> Recheck:
    """Whether a finished platform's calibration still holds, by new views in its own formats.

    Parameters
    ----------
    platform : str
        Its name, as in config/platforms/NAME.yaml.
    data : path_like
        Folder of the new views, laid out as the platform's own.
    project : path_like, optional
        The project's folder, or one below it; by default the current one.
    false_alarms : float, optional
        How often a camera that has not moved may be told to have.

    Returns
    -------
    Recheck
        The move with its sigma, p-values, and the least move that the views could have seen.

    Raises
    ------
    InputError
        The views cannot be used, or there is no calibration by the adjustment.
    EstimationError
        The views lead to no estimate.

    Examples
    --------
    >>> try:
    ...     linepose.recheck_platform("myrobot", "new-views")
    ... except linepose.InputError as error:
    ...     print(error.remedy)
    linepose run myrobot
    """
    root, folder = find_project(project), Path(data)
    loaded, results = load_platform_project(platform, root), root / "results" / platform
    if not (results / "pose.parquet").is_file():
        raise InputError(str(results), "no result", "that of a run", f"linepose run {platform}")
    if not folder.is_dir():
        raise InputError(str(folder), "no such folder", "one with new views", "correct the folder's name")
    settings, study = loaded.platforms[platform], loaded.study
    calibration = Calibration.from_results(results, settings, study.outliers.threshold_px)
    _check_noise_model(calibration)
    observations, known = _new_views(settings, folder)
    return recheck(
        calibration, observations, study.adjustment, known_points=known, seed=study.seed, false_alarms=false_alarms
    )


def _new_views(platform: Platform, folder: Path) -> tuple[pd.DataFrame, dict[str, PointKnowledge]]:
    """Observations of a folder in the platform's own formats, and what is known of their points there."""
    kept = {"left_out": ()} if isinstance(platform.source, ScansSection) else {"first": 1, "step": 1}
    source = platform.source.model_copy(update=kept)  # which of the calibration's views count says nothing of these
    # a prior, since the calibration stands in for what few views lack
    few = platform.model_copy(update={"prior": "hand_measured", "source": source})
    observations = read_observations(few, folder)
    return observations, known_of_platform(few, folder, observations)


def _adjusted_again(calibration: Calibration, section: AdjustmentSection, seed: int) -> Adjustment:
    """The calibration's adjustment with all that its tables leave out; raises InputError where it is another."""
    survey = calibration.survey()
    prior = bool(calibration.diagnostics["disagreement_sigmas"].notna().any())  # told only where it is a prior
    tables = calibration.results
    known = knowledge_from_table(tables.table("known_points", KNOWN_POINTS)) if tables.has("known_points") else {}
    conditions = Conditions(
        calibration.camera,
        calibration.hand_measured,
        prior,
        adjustment=section,
        known_points=known_of_survey(known, survey),
    )
    found = adjustment_estimator(survey, conditions).adjusted(seed=seed)
    if mahalanobis_distance(calibration.pose, found.pose, found.covariance) > _SAME_SIGMAS:
        raise InputError(
            f"results of {calibration.name}",
            "a pose that its observations and settings no longer give",
            "that of the present settings",
            f"calibrate again with `linepose run {calibration.name}`, or give the settings that it was made with",
        )
    return found


def _check_noise_model(calibration: Calibration) -> None:
    if calibration.noise_model != ADJUSTMENT.name:
        raise InputError(
            f"noise model of {calibration.name}",
            calibration.noise_model,
            ADJUSTMENT.name,
            "set noise_model: adjustment in the platform's file and run it again",
        )


def _check(calibration: Calibration, observations: pd.DataFrame, false_alarms: float) -> None:
    _check_noise_model(calibration)
    if not 0 < false_alarms < 1:
        raise InputError("false_alarms", f"{false_alarms}", "a share between 0 and 1", "give 0.05, for one in twenty")
    timed = observations.loc[observations["time_us"] != 0, ["time_us", "u_px"]]
    own = calibration.observations[["time_us", "u_px"]]
    again = len(timed.merge(own, on=["time_us", "u_px"]))
    if again:
        raise InputError(
            f"new views for {calibration.name}",
            f"{again} measurements that the calibration rests on",
            "views taken after it",
            "leave these views out of the folder",
        )
