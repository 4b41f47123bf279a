"""Readers of what a user writes in YAML, and of results on disk."""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import yaml

from linepose.config.platform import load_platform, platform_faults
from linepose.config.project import load_project
from linepose.config.study import load_dataset
from linepose.config.target_file import read_target
from linepose.config.yaml_file import read_yaml
from linepose.pipeline.project_folder import CONFIG
from linepose.survey.observations import OBSERVATIONS
from linepose.survey.targets.registry import KINDS
from linepose.tables import read_table, write_table
from unit.bad_input.reader import Reader, written

CONFIG_FOLDER = Path(__file__).parents[3] / "config"
PLATFORM = b"""description: made up
camera:
  focal_length_m: 0.0062
  pixel_pitch_m: 7.4e-6
  n_pixels: 640
  principal_point_px: 319.5
  sigmas: {u_px: 0.5, v_px: 0.5, principal_point_px: 2.0, focal_length_m: 1.0e-4, k1: 0.0, k2: 0.0}
hand_measured:
  position_m: [0.1, 0.2, -0.3]
  euler_deg: [0.0, 105.0, -90.0]
  sigma_position_m: 0.1
  sigma_rotation_deg: 2.0
source:
  kind: scans
  dataset: made-up
  scans: scans/*.hdr
  time_stamps: rate
  line_rate_hz: 100.0
  start_times: {run-01: 2026-05-01T12:00:00.25Z}
  labels: labels/*.xml
  points: labels
  navigation:
    format: table
    file: log.csv
    time_unit: s
    coordinates: geodetic
    angle_unit: degrees
    columns: {time: t, position: [lat, lon, h], attitude: [roll, pitch, heading]}
target: {kind: points}
points:
  control_points: points.csv
  crs: EPSG:32756
  ground: {height_m: 40.5, sigma_m: 0.1, shift_sigma_m: 0.5}
map_frame: {origin: [-33.8892, 151.1937, 42.5]}
map: {ground: height, height_m: 40.0}
"""


def _platform(folder: Path) -> Any:
    platform_faults(folder, "made-up")
    return load_platform(folder, "made-up")


def _study(folder: Path) -> Any:
    return load_project(read_yaml(folder / CONFIG.name), folder)


def _study_files() -> dict[str, bytes]:
    whole = (CONFIG_FOLDER / "config.yaml").read_bytes()
    study = whole.partition(b"datasets:")[0] + b"coverage:" + whole.partition(b"\n\ncoverage:")[2]
    lines = [line for line in study.splitlines(keepends=True) if not line.startswith(b"  - ladybird")]
    names = [f"{name}.yaml" for name in ("shrimp-sim", "drone-sim")]
    platforms = {name: (CONFIG_FOLDER / "platforms" / name).read_bytes() for name in names}
    return {"config.yaml": b"".join(lines) + b"platforms_folder: .\n"} | platforms


def _stays_below(dataset: Any) -> bool:
    """Whether every file of a data set is in its folder."""
    folder = Path("/folder")
    return all((folder / file).resolve().is_relative_to(folder) for file in dataset.sha256)


def _target(kind: str) -> Reader:
    text = yaml.safe_dump({"target": KINDS[kind]().model_dump(mode="json")}).encode()

    def holds(target: Any) -> bool:
        return target.kind in KINDS

    return Reader(
        f"target {kind}",
        lambda: {"target.yaml": text},
        "target.yaml",
        lambda folder: read_target(folder / "target.yaml"),
        holds,
        of=(f"target {kind}",),
    )


def _results() -> Reader:
    table = pd.DataFrame({one.name: np.arange(1, 9, dtype=one.type.to_pandas_dtype()) for one in OBSERVATIONS})

    def make() -> dict[str, bytes]:
        return {"results.parquet": written(lambda path: write_table(table, path, OBSERVATIONS), "results.parquet")}

    def same(found: pd.DataFrame) -> bool:
        return found[table.columns.tolist()].equals(table)

    read = lambda folder: read_table(folder / "results.parquet", OBSERVATIONS)  # noqa: E731
    return Reader("results parquet", make, "results.parquet", read, same, False, ("results",))


def configuration_readers() -> list[Reader]:
    """All of them."""
    simulated = lambda: {"made-up.yaml": (CONFIG_FOLDER / "platforms" / "shrimp-sim.yaml").read_bytes()}  # noqa: E731
    dataset = lambda: {"made-up.yaml": (CONFIG_FOLDER / "datasets" / "ladybird.yaml").read_bytes()}  # noqa: E731
    of = ("config/platforms",)
    return [
        Reader("platform yaml", simulated, "made-up.yaml", _platform, of=of),
        Reader("platform yaml of scans", lambda: {"made-up.yaml": PLATFORM}, "made-up.yaml", _platform, of=of),
        Reader("config yaml", _study_files, "config.yaml", _study, of=("config/config.yaml",)),
        Reader(
            "data set yaml",
            dataset,
            "made-up.yaml",
            lambda folder: load_dataset(folder / "made-up.yaml"),
            _stays_below,
            of=("config/datasets",),
        ),
        *(_target(kind) for kind in KINDS),
        _results(),
    ]
