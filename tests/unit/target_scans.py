"""Simulated scans of targets of any kind, lying or standing, with where their points truly are."""

from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np

from linepose.arrays import Floats
from linepose.config.platform import load_platform
from linepose.geometry import rotations
from linepose.inputs.scans.scan_files import Scan
from linepose.inputs.targets.rectified import HandView
from linepose.simulation import sensor
from linepose.simulation.projection import exact_projections
from linepose.simulation.record import navigation_log, true_lines
from linepose.simulation.render import render
from linepose.simulation.settings import SimulationSettings
from linepose.simulation.trajectory import time_us
from linepose.survey.navigation_log import NavigationLog
from linepose.survey.observations import EULER_COLUMNS, POSITION_COLUMNS
from linepose.survey.targets.base import TargetSection

ROOT = Path(__file__).parents[2]
LADYBIRD = load_platform(ROOT / "config" / "platforms", "ladybird-sim")
CAMERA = LADYBIRD.intrinsics()


@dataclass(frozen=True)
class TargetScan:
    """A scan, true u and line (M, 2) of the target's points, pixels a line, and which are in the scan (M,)."""

    scan: Scan
    truth: Floats
    px_per_line: Floats
    visible: np.ndarray


def survey_of(target: TargetSection, passes: tuple[int, ...], upright: bool = False) -> SimulationSettings:
    """Passes of the simulated Ladybird by their numbers from 1, each 5 s long, past a target in the board's place."""
    settings = LADYBIRD.simulation
    chosen = tuple(replace(settings.passes[number - 1], duration_s=5.0) for number in passes)
    board = replace(settings.board, target=target)
    if upright:
        away = -np.array([chosen[0].north_m, chosen[0].east_m, 0.0])
        away /= np.linalg.norm(away)
        down = np.array([0.0, 0.0, 1.0])
        turned = rotations.euler_from_matrix(np.stack([np.cross(down, away), down, away], axis=-1))
        board = replace(board, euler_rad=tuple(turned.tolist()))
    image = replace(settings.image, supersampling=3, n_bands=1, line_rate_hz=60.0, margin_share=0.3)
    return replace(settings, faults=(), passes=chosen, board=board, image=image, transfer_s=4.0)


@lru_cache(maxsize=8)
def scan_of(settings: SimulationSettings, number: int) -> TargetScan:
    """The scan of one of a survey's passes."""
    exposure = render(CAMERA, settings, number)
    rng = np.random.default_rng(number)
    light = sensor.expose(rng, settings.image, exposure.light).mean(axis=1).astype(np.float32)
    truth, lines = exact_projections(CAMERA, settings), true_lines(CAMERA, settings)[number - 1]
    place = np.stack([truth.u_px[number - 1], lines], axis=-1)
    visible = np.all((place >= 0) & (place <= np.array(light.shape[::-1]) - 1), axis=1)
    scan = Scan(light, time_us(settings, exposure.time_s), f"scan-{number}")
    return TargetScan(scan, place, truth.v_px_s[number - 1] / settings.image.line_rate_hz, visible)


def hand_view(settings: SimulationSettings, range_m: float | None = None) -> HandView:
    """The camera at its hand-measured pose, with the log of a survey."""
    table = navigation_log(settings)
    position, euler = (table[list(names)].to_numpy() for names in (POSITION_COLUMNS, EULER_COLUMNS))
    return HandView(CAMERA, LADYBIRD.start_pose(), NavigationLog(table["time_us"].to_numpy(), position, euler), range_m)
