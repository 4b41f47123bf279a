"""Every figure: its name, what it shows in words, how it is drawn from a platform's results, and its caption."""

from collections.abc import Callable
from typing import Final

import pandas as pd
from matplotlib.figure import Figure

from linepose.config.platform import Platform
from linepose.estimation.outliers import OUTLIERS
from linepose.experiments.basin import BASIN, BASIN_SUMMARY
from linepose.experiments.basin import SECTION as BASIN_SECTION
from linepose.experiments.mapping import MAPPING, MAPPING_SUMMARY
from linepose.experiments.mapping import SECTION as MAPPING_SECTION
from linepose.experiments.repeatability import REPEATABILITY
from linepose.experiments.repeatability import SECTION as REPEATABILITY_SECTION
from linepose.experiments.splits import SPLITS
from linepose.experiments.uncertainty import UNCERTAINTY
from linepose.output.figures import (
    basin,
    corner_plot,
    mapping,
    outlier_matrix,
    platform_sketch,
    repeatability,
    residuals,
    rotation_axis,
    scan,
    survey_plan,
    trace,
    uncertainty,
)
from linepose.output.figures.entry import CatalogueEntry, without
from linepose.output.figures.noise_catalogue import NOISE_FIGURES
from linepose.output.figures.scan_example import scan_examples
from linepose.pipeline.calibration import Calibration
from linepose.pipeline.residual_tables import ESTIMATED_POINTS, RESIDUALS
from linepose.pipeline.stages import DIAGNOSTICS
from linepose.survey.observations import OBSERVATIONS


def _mapping(r: Calibration) -> Figure:
    points = r.results.table("estimated_points", ESTIMATED_POINTS)
    mapped = r.results.table("mapping", MAPPING)
    observations = r.results.table("observations", OBSERVATIONS)
    return mapping.mapping(mapped, points, observations, r.inliers[0], r.true_points_m)


def _angle_error(r: Calibration) -> Figure:
    points = r.results.table("estimated_points", ESTIMATED_POINTS)
    mapped = r.results.table("mapping", MAPPING)
    observations = r.results.table("observations", OBSERVATIONS)
    return mapping.angle_error(mapped, points, observations, _angle_deg(r), r.true_points_m)


def _angle_deg(r: Calibration) -> float:
    settings = MAPPING_SECTION.of(r.platform_file)
    return settings.perturbation_deg if settings else 0.0


def _basin(r: Calibration) -> Figure:
    settings = BASIN_SECTION.of(r.platform_file)
    assert settings is not None  # left_out says so before
    return basin.basin(r.results.table("basin", BASIN), settings.region())


def _basin_caption(r: Calibration) -> str:
    settings = BASIN_SECTION.of(r.platform_file)
    assert settings is not None
    return basin.basin_caption(r.results.table("basin_summary", BASIN_SUMMARY), settings.region())


def _sketch(r: Calibration) -> Figure:
    assert r.platform_file.outline is not None
    return platform_sketch.platform_sketch(r.samples, r.platform_file.outline, r.marked_poses())


def _named_pair(r: Calibration) -> pd.DataFrame | None:
    return r.results.table("repeatability", REPEATABILITY) if r.results.has("repeatability") else None


def _trace(r: Calibration) -> Figure:
    marked = {name: pose for name, pose in r.marked_poses().items() if name != "hand measured"}
    return trace.trace(r.samples, marked)


def _diagnostics_caption(r: Calibration) -> str:
    n_steps = int(r.samples["step"].max()) + 1
    return trace.autocorrelation_caption(r.results.table("diagnostics", DIAGNOSTICS), n_steps)


def _residuals(by: str) -> Callable[[Calibration], Figure]:
    return lambda r: residuals.residuals(r.results.table("residuals", RESIDUALS), by)


def _residuals_caption(by: str) -> Callable[[Calibration], str]:
    return lambda r: residuals.residuals_caption(r.results.table("residuals", RESIDUALS), by)


def _without_splits(platform: Platform) -> str:
    settings = REPEATABILITY_SECTION.of(platform)
    told = "This experiment was not asked for: experiments.repeatability has no splits in the platform's file."
    return "" if settings and settings.n_splits else told


def _without_outline(platform: Platform) -> str:
    return "" if platform.outline else "The platform's file has no outline to draw on: add one under `outline`."


def _without_scans(platform: Platform) -> str:
    kind = platform.source.kind
    told = "This platform has no scans: its points were labelled before they came here."
    return told if kind == "labelled_views" else ""


def _without_truth(platform: Platform) -> str:
    told = "Detection is tried beside the labels only where the truth is known: in simulated platforms."
    return "" if platform.simulation else told


FIGURES: Final = (
    CatalogueEntry(
        "survey_plan",
        "Survey from above",
        "Figure 5",
        "map of the observations around the pattern, numbered and coloured by tilt",
        lambda r: survey_plan.survey_plan(r.survey(), r.inliers, r.results.table("estimated_points", ESTIMATED_POINTS)),
        lambda r: survey_plan.survey_plan_caption(r.survey(), r.inliers),
    ),
    CatalogueEntry(
        "stacked_scan",
        "Stacked scan",
        "Figure 6",
        "grey images of a few observations' scan lines with the pattern's sheet framed",
        lambda r: scan.stacked_scan(scan_examples(r, "points")),
        lambda r: scan.stacked_scan_caption(scan_examples(r, "points")),
        _without_scans,
    ),
    CatalogueEntry(
        "labelled_points",
        "Points found in the scan",
        "Figure 7",
        "close-ups of the pattern in scans, each point crossed and numbered",
        lambda r: scan.points_in_scan(scan_examples(r, "points")),
        lambda r: scan.labelled_points_caption(scan_examples(r, "points")),
        _without_scans,
    ),
    CatalogueEntry(
        "detected_points",
        "Points detected without labels",
        "",
        "close-ups of the pattern in scans, each detected point crossed and numbered",
        lambda r: scan.points_in_scan(scan_examples(r, "detected_points")),
        lambda r: scan.detected_points_caption(scan_examples(r, "detected_points")),
        _without_truth,
    ),
    CatalogueEntry(
        "outliers",
        "Outlier removal",
        "Figure 8",
        "matrix of mean errors, observations across, stages of the removal down, the accepted row framed",
        lambda r: outlier_matrix.outlier_matrix(r.results.table("outliers", OUTLIERS)),
        lambda r: outlier_matrix.outlier_matrix_caption(r.results.table("outliers", OUTLIERS), r.threshold_px),
    ),
    CatalogueEntry(
        "uncertainty",
        "Uncertainty against observations",
        "Figure 9",
        "lines of the sigma of each pose parameter against the number of observations",
        lambda r: uncertainty.uncertainty(r.results.table("uncertainty", UNCERTAINTY)),
        lambda r: uncertainty.uncertainty_caption(r.results.table("uncertainty", UNCERTAINTY)),
    ),
    CatalogueEntry(
        "corner",
        "Posterior of the pose",
        "Figure 10",
        "histograms and contours of every pair of pose parameters with the optimum and the hand measurement marked",
        lambda r: corner_plot.corner_plot(r.samples, r.marked_poses()),
        lambda r: corner_plot.corner_plot_caption(r.samples),
    ),
    CatalogueEntry(
        "rotation_axis",
        "Rotation axis and angle",
        "Figure 11",
        "sampled rotation axes on a sphere and close up, and a histogram of the angle",
        lambda r: rotation_axis.rotation_axis(r.samples, r.marked_poses()),
        lambda r: rotation_axis.rotation_axis_caption(r.samples, r.pose_of("hand_measured")),
    ),
    CatalogueEntry(
        "platform_sketch",
        "Poses on the platform",
        "Figure 12",
        "sampled camera positions and optical axes over a sketch of the platform from the side and the front",
        _sketch,
        lambda r: platform_sketch.platform_sketch_caption(r.samples),
        _without_outline,
    ),
    CatalogueEntry(
        "mapping",
        "Mapping before and after",
        "Figure 13",
        "the pattern's points projected to its plane before and after the calibration",
        _mapping,
        lambda r: mapping.mapping_caption(r.results.table("mapping_summary", MAPPING_SUMMARY), r.inliers[0]),
        without("mapping"),
    ),
    CatalogueEntry(
        "angle_error",
        "Effect of an angle error",
        "Figure 14",
        "the pattern's points projected with the calibrated pose and with one turned by a small angle",
        _angle_error,
        lambda r: mapping.angle_error_caption(r.results.table("mapping_summary", MAPPING_SUMMARY), _angle_deg(r)),
        without("mapping"),
    ),
    CatalogueEntry(
        "basin",
        "Basin of attraction",
        "Figure 15",
        "grid of starts over distance and angle, coloured by whether the search found the optimum",
        _basin,
        _basin_caption,
        without("basin"),
    ),
    CatalogueEntry(
        "trace",
        "Trace of the chain",
        "",
        "each pose parameter over the steps of the chain",
        _trace,
        lambda r: trace.trace_caption(r.results.table("diagnostics", DIAGNOSTICS)),
    ),
    CatalogueEntry(
        "autocorrelation",
        "Autocorrelation of the chain",
        "",
        "autocorrelation of each pose parameter against the lag in steps",
        lambda r: trace.autocorrelation(r.samples),
        _diagnostics_caption,
    ),
    CatalogueEntry(
        "residuals_by_observation",
        "Residuals by observation",
        "",
        "errors along and across the scan line by observation, with their sigmas",
        _residuals("observation"),
        _residuals_caption("observation"),
    ),
    CatalogueEntry(
        "residuals_by_point",
        "Residuals by point",
        "",
        "errors along and across the scan line by point of the pattern, with their sigmas",
        _residuals("point"),
        _residuals_caption("point"),
    ),
    CatalogueEntry(
        "repeatability",
        "Repeatability",
        "",
        "histogram of the distance between poses from disjoint halves of the observations",
        lambda r: repeatability.repeatability(r.results.table("splits", SPLITS), _named_pair(r)),
        lambda r: repeatability.repeatability_caption(r.results.table("splits", SPLITS), _named_pair(r)),
        _without_splits,
    ),
    *NOISE_FIGURES,
)
