"""Files as a platform's devices write them: labelled views and covariances of a simulated survey, without images."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from spectral.io.envi import write_envi_header

from linepose.config.platform import Platform
from linepose.simulation.envi import write_line_times
from linepose.simulation.record import labels, navigation_log, write_covariances
from linepose.simulation.render import line_times_s
from linepose.simulation.survey import reported_covariance, simulate_survey, without_faults
from linepose.simulation.trajectory import time_us
from linepose.survey.observations import Survey

VIEWS = "labelled_points"


def simulated_survey(platform: Platform, n_observations: int = 0, faults: bool = False) -> Survey:
    """A simulated survey of a platform with a simulation; the first passes only, where a number is given."""
    assert platform.simulation is not None
    settings = platform.simulation if faults else without_faults(platform.simulation)
    survey, _ = simulate_survey(platform.intrinsics(), settings, seed=5)
    return survey.select(list(survey.number[:n_observations])) if n_observations else survey


def write_labelled_views(folder: Path, survey: Survey, covariance: np.ndarray) -> None:
    """One CSV file a view, and 12x12 covariances at 1 Hz: position and angles (6, 6) in rows and columns 0-5."""
    (folder / VIEWS).mkdir(parents=True)
    for row, number in enumerate(survey.number):
        lines = []
        for point in np.flatnonzero(np.isfinite(survey.u_px[row])):
            values = [*(survey.position_m[row, point] + survey.origin_m), *survey.euler_rad[row, point]]
            cells = [f"{survey.u_px[row, point]:.6g}", *(f"{value:.12g}" for value in values)]
            lines.append(",".join([str(survey.time_us[row, point]), str(point), *cells]))
        (folder / VIEWS / f"view{number:03d}.csv").write_text("\n".join(lines) + "\n")
    matrix = np.zeros((12, 12))
    matrix[:6, :6] = covariance
    cells = ",".join(f"{value:.8g}" for value in matrix.ravel())
    seen = survey.time_us[np.isfinite(survey.u_px)]
    stamps = np.arange(seen.min() - 1_000_000, seen.max() + 1_000_000, 1_000_000)
    (folder / "nav_covs.csv").write_text("".join(f"{stamp},{cells}\n" for stamp in stamps))


def write_platform_files(folder: Path, platform: Platform, n_observations: int = 0, faults: bool = False) -> Survey:
    """The files of a simulated platform as labelled views; the survey behind them."""
    survey = simulated_survey(platform, n_observations, faults)
    assert platform.simulation is not None
    write_labelled_views(folder, survey, reported_covariance(platform.simulation.reported_sigma))
    return survey


def write_scan_files(folder: Path, platform: Platform, n_observations: int) -> None:
    """The files of the first passes of a simulated platform as scans: all that a check reads.

    Their pictures are dark, with a dot under each label.
    """
    assert platform.simulation is not None
    settings = replace(platform.simulation, passes=platform.simulation.passes[:n_observations], faults=())
    camera = platform.intrinsics()
    (folder / "scans").mkdir(parents=True)
    navigation_log(settings).to_parquet(folder / "navigation.parquet", index=False)
    write_covariances(folder / "covariances.csv", settings)
    labelled = labels(camera, settings)
    labelled.to_csv(folder / "labels.csv", index=False, float_format="%.2f")
    for number in range(1, n_observations + 1):
        stamps = time_us(settings, line_times_s(camera, settings, number))
        path = folder / "scans" / f"observation-{number:02d}"
        write_line_times(path, stamps)
        size = {"samples": camera.n_pixels, "lines": len(stamps), "bands": 1}
        write_envi_header(str(path.with_suffix(".hdr")), size | _ENVI)
        picture = np.zeros((len(stamps), camera.n_pixels), dtype="<u2")
        mine = labelled[labelled["observation"] == number]
        for line, u in np.rint(mine[["line", "u_px"]].to_numpy()).astype(int):
            picture[max(line - 1, 0) : line + 2, max(u - 1, 0) : u + 2] += 500
            picture[line, u] += 500
        picture.tofile(path.with_suffix(".bil"))


_ENVI = {"header offset": 0, "file type": "ENVI Standard", "data type": 12, "interleave": "bil", "byte order": 0}
