"""An adjustment with the known geometry of a board: first without it, to see whether it fits and what it gains."""

from dataclasses import replace

import numpy as np

from linepose.adjustment.all_at_once import AllAtOnce, adjust_all
from linepose.adjustment.assemble import assembled, pose_covariance
from linepose.adjustment.board_fit import BoardFit, misfit_of_board, scale_of_board
from linepose.adjustment.hand_measured import HandMeasuredPrior
from linepose.adjustment.known_board import spreads
from linepose.adjustment.known_points import KnownPoints
from linepose.adjustment.many_points import MANY_POINTS
from linepose.adjustment.measurements import Measurements, measurements_from_survey
from linepose.adjustment.normal import joint_covariance
from linepose.adjustment.result import Adjustment
from linepose.adjustment.settings import AdjustmentSettings
from linepose.adjustment.state import Knowledge
from linepose.arrays import Floats
from linepose.errors import EstimationError, InputError
from linepose.survey.observations import Survey


def adjusted_with_board(
    survey: Survey,
    known_points: KnownPoints,
    measurements: Measurements,
    knowledge: Knowledge,
    start: Floats,
    hand: HandMeasuredPrior,
    settings: AdjustmentSettings,
) -> Adjustment:
    """The adjustment of measurements whose points lie on a known board, or without its geometry where that is wrong.

    known_points: of all the survey's. Raises InputError where there are too many points, EstimationError where there
    is no estimate.
    """
    if measurements.n_points > MANY_POINTS:
        raise InputError(
            "known points, board",
            f"{measurements.n_points} points",
            f"at most {MANY_POINTS} where the target's geometry counts",
            "leave out target.known, or points",
        )
    fit = BoardFit(int(measurements.known.on_board.sum()))
    try:
        free = measurements_from_survey(survey, knowledge.camera, known_points.without_board, settings.line_period_s)
        plain = adjust_all(free, knowledge, start, hand, settings)
    except (InputError, EstimationError):
        plain = None  # only the board makes an estimate possible
    if plain is not None:
        fit, start = _compared(fit, known_points.select(free.points), plain), plain.fit.state.pose
        if not fit.counts:
            return assembled(survey, free, knowledge, plain, settings, fit)
    done = adjust_all(measurements, knowledge, start, hand, settings)
    return assembled(survey, measurements, knowledge, done, settings, fit)


def _compared(fit: BoardFit, known: KnownPoints, plain: AllAtOnce) -> BoardFit:
    """The board beside what an adjustment without it found of the same points, where these hold a board's pose."""
    sigma = np.sqrt(np.diag(pose_covariance(plain.fit.state, plain.spread)))
    rows = known.on_board
    if not spreads(known.board_m, rows):
        return replace(fit, sigma_without=sigma)
    board_m, points_m = known.board_m[rows], plain.fit.state.points_m[rows]
    covariance = joint_covariance(plain.found.solution.done.upper, known.shifts, rows)
    return replace(
        fit,
        misfit_sigmas=misfit_of_board(board_m, known.board_sigma_m, points_m, covariance),
        scale=scale_of_board(board_m, points_m),
        sigma_without=sigma,
    )
