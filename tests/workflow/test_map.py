"""The scans of the finished project on the map: marks of a known place lie where the files say."""

import json

import numpy as np
import pandas as pd
import pytest
import rasterio
from scipy.ndimage import map_coordinates

from linepose.survey.observations import POSITION_COLUMNS

pytestmark = pytest.mark.workflow
N_PIXELS = 648


def bands_at(path, kind, n_bands, marks):
    """The bands (M, B) of a file that is interleaved by line, at marks' lines and pixels."""
    bands = np.fromfile(path, dtype=kind).reshape(-1, n_bands, N_PIXELS)
    places = marks[["line", "u_px"]].to_numpy().T
    return np.stack([map_coordinates(bands[:, band], places, order=1) for band in range(n_bands)], axis=-1)


def mark_in_map(path, near_m, half_m=0.04):
    """Easting and northing of the centroid of the light around a place in a GeoTIFF."""
    with rasterio.open(path) as file:
        bounds = np.concatenate([near_m - half_m, near_m + half_m])
        window = file.window(*bounds).round_offsets().round_lengths()
        light, transform = file.read(1, window=window).astype(float), file.window_transform(window)
    weight = np.clip(light - np.quantile(light, 0.6), 0, None).ravel()
    row, column = (np.average(one.ravel() + 0.5, weights=weight) for one in np.indices(light.shape))
    return np.array([transform.c + transform.a * column, transform.f + transform.e * row])


def test_marks_on_the_board_lie_where_the_map_says(finished):
    results = finished.folder / "results" / "tiny"
    truth = pd.read_parquet(results / "truth.parquet").query("visible")
    true_m = truth[[f"point_{name}" for name in POSITION_COLUMNS]].to_numpy()[:, [1, 0, 2]] * [1, 1, -1]
    in_geotiff = np.full((len(truth), 2), np.nan)
    found, sigma = np.full((len(truth), 3), np.nan), np.full((len(truth), 4), np.nan)
    for number in truth["observation"].unique():
        stem, mine = results / "map" / f"observation-{number:02d}", (truth["observation"] == number).to_numpy()
        found[mine] = bands_at(f"{stem}-igm.dat", np.float64, 3, truth[mine])
        sigma[mine] = bands_at(f"{stem}-sigma.dat", np.float32, 4, truth[mine])
        in_geotiff[mine] = [mark_in_map(f"{stem}.tif", near_m) for near_m in true_m[mine, :2]]
        record = json.loads((results / "map" / f"{stem.name}-map.json").read_text())
        assert {row["source"] for row in record["budget"]} >= {"pose", "intrinsics", "navigation", "pixel", "ground"}
    error = found - true_m
    assert np.all(np.abs(error[:, :2]) < 3 * sigma[:, :2])
    assert np.all(np.hypot(error[:, 0], error[:, 1]) < 0.03)  # a hundredth of the range
    # the points' plane errs with the camera's height, which the paper's likelihood states too surely
    assert np.ptp(error[:, 2]) < 0.01
    assert np.all(np.abs(in_geotiff - true_m[:, :2]) < np.minimum(3 * sigma[:, :2], 0.03))
    budget = pd.read_parquet(results / "map_budget.parquet")
    assert budget["scan"].nunique() == 4
    assert "Error budget of each scan" in (results / "report.html").read_text()


def test_lost_and_unfinished_maps_are_made_again_to_the_same_bytes(copied):
    """As after a kill: without the list the run is not done, and what is finished stays. By two jobs."""
    results = copied.folder / "results" / "tiny"
    before = {path.name: path.read_bytes() for path in (results / "map").iterdir()}
    kept = results / "map" / "observation-01-igm.dat"
    made_at = kept.stat().st_mtime_ns
    (results / "map" / "observation-03-igm.dat").unlink()
    (results / "map" / ".12345678-observation-03-sigma.dat").touch()
    run = copied.run("results/tiny/map_files.txt", "--set-scatter", "maps=2", cores=1)
    assert run.returncode == 0, run.stderr
    logs = copied.folder / "results" / "logs" / "tiny"
    shares = [(logs / f"map_{number}-of-2.log").read_text() for number in (1, 2)]
    assert [("map_part: 2 of 2" in share, "map_part: 3" in share) for share in shares] == [(True, False)] * 2
    assert "map: 4 of 4" in (logs / "map.log").read_text()
    assert not list(logs.glob("*.done"))
    assert {path.name: path.read_bytes() for path in (results / "map").iterdir()} == before
    assert kept.stat().st_mtime_ns == made_at
    again = copied.linepose("map", "tiny")
    assert again.stdout.count("(made before)") == 4
    assert "\n4 of 4 were finished before, of the same numbers, and left as they are\n" in again.stdout
