"""Results of a made-up platform: small, written by hand, with numbers that tests can look for in pictures and pages."""

from pathlib import Path

from linepose.config.platform import Platform
from linepose.estimation.outliers import OUTLIERS
from linepose.experiments.basin import BASIN, BASIN_SUMMARY
from linepose.experiments.clock_offset import CLOCK_OFFSET
from linepose.experiments.leave_one_out import LEAVE_ONE_OUT
from linepose.experiments.mapping import MAPPING, MAPPING_SUMMARY
from linepose.experiments.prior import IDENTIFIABILITY, PRIOR_TABLE
from linepose.experiments.splits import SPLITS
from linepose.experiments.uncertainty import UNCERTAINTY
from linepose.pipeline.residual_tables import ESTIMATED_POINTS, RESIDUALS
from linepose.pipeline.stages import DIAGNOSTICS, OPTIMA, POSE, SAMPLES
from linepose.survey.observations import OBSERVATIONS
from linepose.tables import write_table
from unit import made_up_adjustment
from unit.made_up_estimate import (
    diagnostics,
    estimated_points,
    observations,
    optima,
    outliers,
    pose,
    residuals,
    samples,
)
from unit.made_up_experiments import (
    basin,
    basin_summary,
    clock_offset,
    identifiability,
    leave_one_out,
    mapping,
    mapping_summary,
    prior,
    splits,
    uncertainty,
)
from unit.made_up_platform import (
    ACCEPTED,
    N_STEPS,
    OPTIMUM,
    ORIGIN,
    PLATFORM,
    POINTS,
    platform,
)

__all__ = [
    "ACCEPTED",
    "N_STEPS",
    "OPTIMUM",
    "ORIGIN",
    "PLATFORM",
    "POINTS",
    "TABLES",
    "adjusted_platform",
    "basin",
    "basin_summary",
    "clock_offset",
    "estimated_points",
    "mapping",
    "mapping_summary",
    "observations",
    "outliers",
    "platform",
    "pose",
    "prior",
    "residuals",
    "samples",
    "splits",
    "uncertainty",
    "write_adjusted_results",
    "write_results",
]

TABLES = {
    "prior": (prior, PRIOR_TABLE),
    "clock_offset": (clock_offset, CLOCK_OFFSET),
    "observations": (observations, OBSERVATIONS),
    "outliers": (outliers, OUTLIERS),
    "optima": (optima, OPTIMA),
    "pose": (pose, POSE),
    "mcmc/inliers": (samples, SAMPLES),
    "diagnostics": (diagnostics, DIAGNOSTICS),
    "residuals": (residuals, RESIDUALS),
    "estimated_points": (estimated_points, ESTIMATED_POINTS),
    "mapping": (mapping, MAPPING),
    "mapping_summary": (mapping_summary, MAPPING_SUMMARY),
    "basin": (basin, BASIN),
    "basin_summary": (basin_summary, BASIN_SUMMARY),
    "splits": (splits, SPLITS),
    "leave_one_out": (leave_one_out, LEAVE_ONE_OUT),
    "uncertainty": (uncertainty, UNCERTAINTY),
    "identifiability": (identifiability, IDENTIFIABILITY),
    **made_up_adjustment.BESIDE,
}
ADJUSTED = {
    name: TABLES[name]
    for name in ("prior", "identifiability", "observations", "mcmc/inliers", "residuals", "estimated_points", "splits")
} | {name: TABLES[name] for name in ("mapping", "mapping_summary", "leave_one_out")}


def write_results(folder: Path) -> None:
    """Write every table of the made-up platform into a folder."""
    for name, (make, schema) in TABLES.items():
        write_table(make(), folder / f"{name}.parquet", schema)


def adjusted_platform() -> Platform:
    """The made-up platform with the adjustment for its noise model."""
    return platform(noise_model="adjustment", prior="hand_measured", experiments={"basin": None})


def write_adjusted_results(folder: Path) -> None:
    """Write every table of the made-up platform under the adjustment: one stage, all observations in it."""
    for name, (make, schema) in ADJUSTED.items():
        write_table(make(), folder / f"{name}.parquet", schema)
    told = {"pareto_shape": 0.3, "least_eigenvalue": 0.9, "disagreement_sigmas": 0.5, "warning": "few draws"}
    whole = outliers().query("n_observations == 6").assign(accepted=True, removed=False)
    write_table(whole, folder / "outliers.parquet", OUTLIERS)
    write_table(optima().query("stage == 'inliers'"), folder / "optima.parquet", OPTIMA)
    write_table(pose().query("stage in ('hand_measured', 'inliers')"), folder / "pose.parquet", POSE)
    write_table(diagnostics().assign(**told), folder / "diagnostics.parquet", DIAGNOSTICS)
    for name in ("levels", "adjusted_intrinsics", "adjusted_views", "adjusted_measurements"):
        make, schema = made_up_adjustment.BESIDE[name]
        write_table(make(), folder / f"{name}.parquet", schema)
