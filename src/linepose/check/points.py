"""What is known of points beside their measurements: whether it can be used, and where it lies."""

from pathlib import Path

import pandas as pd

from linepose.adjustment.known_points import KnownPoints
from linepose.check.finding import Finding, of_fault, ok
from linepose.config.platform import Platform
from linepose.errors import InputError
from linepose.pipeline.known_points import known_of_platform, known_of_survey
from linepose.survey.observations import survey_from_table

_SUBJECT = "known points"


def point_findings(
    settings: Platform, folder: Path, observations: pd.DataFrame
) -> tuple[list[Finding], KnownPoints | None]:
    """Findings on control points and ground, and what is known of the points; None where nothing is."""
    if not settings.knows_points:
        return [], None
    try:
        known = known_of_platform(settings, folder, observations)
    except InputError as fault:
        return [of_fault(_SUBJECT, fault)], None
    shared = sum(one.shared for one in known.values())
    found = f"something is known of {len(known)} points"
    if shared:
        found += f", of {shared} a height that errs in common"
    on_board = [one.board_sigma_m for one in known.values() if one.board_sigma_m is not None]
    if on_board:
        found += f", of {len(on_board)} the place on the target, to {1e3 * on_board[0]:g} mm"
    return [ok(_SUBJECT, found)], known_of_survey(known, survey_from_table(observations))
