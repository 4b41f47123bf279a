"""What maps cost: places with sigmas, lookup table, GeoTIFF; `python benchmarks/maps.py`.

A made-up strip of 648 pixels x 10,000 lines over an elevation model, 40 m below, on two cores, compiling done before,
beside what is asked for. The GeoTIFF has 244 bands of a tenth of the lines, with `--large` of all, for which it needs
15 GB of disk; beside it the same number of bytes written at once. `--gref4hsi PYTHON` takes the interpreter of an
environment with gref4hsi, and has it trace the same rays to a mesh of the same heights.
"""

import argparse
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from linepose.adjustment.levels import Levels
from linepose.geometry.camera import Camera, pixel_directions
from linepose.geometry.rotations import matrix_from_euler
from linepose.inputs.scans.scan_bands import open_bands
from linepose.output.map.frame import SurveyMap
from linepose.output.map.geotiff import Layers, write_geotiff
from linepose.output.map.glt import write_glt
from linepose.output.map.ground import Ground, flat_ground
from linepose.output.map.lattice import lattice_of
from linepose.output.map.places import Navigation, ScanOnMap
from linepose.output.map.sources import MountedCamera
from linepose.output.map.write_places import write_places
from linepose.simulation import envi
from linepose.survey.navigation import NavigationCovariances
from linepose.survey.navigation_log import NavigationLog, interpolated_pose

CAMERA = Camera(focal_length_m=8.2e-3, pixel_pitch_m=7.407e-6, n_pixels=648, principal_point_px=323.5)
BENT = CAMERA.replaced(k1=-0.05, k3=0.02, p2=0.002, smile=0.01)
POSE = np.array([0.2, -0.1, 0.1, 0.0, 0.0, np.pi / 2])
N_LINES, N_BANDS, N_CORES = 10_000, 244, 2
PLACES_S, GLT_S, DISK_SHARE = 5, 3, 0.5
LINE_US, START_US = 10_000, 1_700_000_000_000_000
SPEED_M_S, HEIGHT_M, CELL_M = 4.0, 40.0, 1.0
LARGEST_RAY_M = 200.0

# in an environment with gref4hsi: its own method, without the modules that it imports beside and does not use
TRACE = """
import contextlib, io, sys, time
from unittest.mock import MagicMock
unused = '''osgeo osgeo.gdal osgeo.osr open3d xmltodict ephem psutil rasterio rasterio.transform rasterio.windows
shapely shapely.geometry pandas pymap3d dateutil gref4hsi.utils.gis_tools'''
for name in unused.split():
    sys.modules[name] = MagicMock()
import numpy as np, pyvista
from gref4hsi.utils.geometry_utils import CameraGeometry
from scipy.spatial.transform import Rotation
given = np.load(sys.argv[1])
mesh = pyvista.PolyData(given["points"], np.insert(given["faces"], 0, 3, axis=1).ravel())
mesh.cell_normals
camera = CameraGeometry(given["centre"], Rotation.from_matrix(given["turn"]), np.zeros(len(given["centre"])))
camera.position_ecef, camera.rotation_hsi = given["centre"], Rotation.from_matrix(given["turn"])
start = time.perf_counter()
with contextlib.redirect_stdout(io.StringIO()):
    camera.defineRayDirections(given["rays"])
    camera.intersect_with_mesh(mesh, float(sys.argv[2]), np.zeros(3))
print(time.perf_counter() - start)
np.save(sys.argv[3], camera.points_ecef_crs[::97, ::29])
"""


def strip(n_lines: int, ground: Ground, camera: Camera = CAMERA) -> ScanOnMap:
    """A strip northwards at 4 m/s, a hundred lines a second, of a body that swings."""
    seconds = np.arange(-1.0, n_lines * LINE_US / 1e6 + 1.0, 0.005)
    position = np.stack([SPEED_M_S * seconds, 0.3 * np.sin(seconds), np.full_like(seconds, -HEIGHT_M)], axis=-1)
    euler = np.stack([0.02 * np.sin(0.9 * seconds), 0.015 * np.cos(0.7 * seconds), 0.02 * np.sin(seconds)], axis=-1)
    time_us = START_US + np.rint(seconds * 1e6).astype(np.int64)
    covariance = np.diag([0.02, 0.02, 0.03, 3e-4, 3e-4, 1e-3]) ** 2
    reported = NavigationCovariances(time_us[::200], np.broadcast_to(covariance, (len(time_us[::200]), 6, 6)))
    navigation = Navigation(NavigationLog(time_us, position, euler), interpolated_pose, reported, 0.1, 1.0)
    mounted = MountedCamera(
        camera, POSE, np.diag([0.01, 0.01, 0.02, 1e-3, 1e-3, 1e-3]) ** 2, Levels(0.5, 0.3, 0.4, 0.6, 0.5, 60.0, 1.0)
    )
    times = START_US + LINE_US * np.arange(n_lines)
    return ScanOnMap("strip", times, mounted, navigation, ground, SurveyMap(None), np.zeros(6))


def hills(n_lines: int) -> Ground:
    """An elevation model below the strip."""
    length_m = SPEED_M_S * n_lines * LINE_US / 1e6
    north = np.arange(length_m + 40.0, -40.0, -CELL_M)
    east = np.arange(-40.0, 40.0, CELL_M)
    heights = np.sin(north / 15.0)[:, None] + 0.5 * np.cos(east / 9.0)
    return Ground(0.05, np.array([0.0, 0.0, -1.0]), 0.0, heights.astype(np.float32), (float(north[0]), -40.0))


def seconds(work: Callable[[], object]) -> float:
    """Wall time of one run."""
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


def touched(path: Path) -> Path:
    """The path of a new, empty file."""
    path.write_bytes(b"")
    return path


def told(what: str, found_s: float, asked: str = "") -> None:
    """Print one row."""
    print(f"{what:<74}{found_s:8.2f} s   {asked}".rstrip(), flush=True)


def places(folder: Path, name: str, scan: ScanOnMap) -> Path:
    """Write places and sigmas, and print how long it took; where the places are."""
    paths = touched(folder / f"{name}-igm.dat"), touched(folder / f"{name}-sigma.dat")
    lines, pixels = scan.shape
    found_s = seconds(lambda: write_places(scan, *paths, N_CORES))
    told(f"{pixels} x {lines} lines, places and sigmas, {name}", found_s, f"asked: {PLACES_S} s")
    return paths[0]


def table(folder: Path, path: Path) -> None:
    """Write the lookup table and print how long it took, compiling done by one of few lines."""
    whole = np.memmap(path, dtype="<f8", mode="r", shape=(N_LINES, 3, CAMERA.n_pixels))

    def write(n_lines: int) -> None:
        lattice = lattice_of(whole[:n_lines], None, "strip", N_CORES)
        assert lattice is not None
        write_glt(whole[:n_lines], lattice, touched(folder / "glt.dat"), N_CORES)

    write(300)
    told(f"{CAMERA.n_pixels} x {N_LINES} lines, lookup table", seconds(lambda: write(N_LINES)), f"asked: {GLT_S} s")


def geotiff(folder: Path, path: Path, n_lines: int) -> None:
    """Write a GeoTIFF of all bands, and as many bytes at once; print both speeds."""
    random = np.random.default_rng(0)
    block = random.integers(0, 4096, (100, N_BANDS, CAMERA.n_pixels), dtype=np.uint16)
    envi.write_scan(folder / "bands", (block for _ in range(n_lines // 100)), np.linspace(400, 1000, N_BANDS))
    whole = np.memmap(path, dtype="<f8", mode="r", shape=(N_LINES, 3, CAMERA.n_pixels))
    igm, scan = whole[:n_lines], open_bands(folder / "bands.hdr")
    lattice = lattice_of(igm, None, "strip", N_CORES)
    assert lattice is not None
    layers = Layers(tuple(range(1, N_BANDS + 1)), "nearest", "none")
    os.sync()

    def write() -> None:
        write_geotiff(igm, lattice, SurveyMap(None), scan, layers, folder / "map.tif", N_CORES)
        os.sync()

    taken_s = seconds(write)
    size_mb = (folder / "map.tif").stat().st_size / 1e6
    disk_s = seconds(lambda: write_plainly(folder / "plain", size_mb))
    what = f"{CAMERA.n_pixels} x {n_lines} lines x {N_BANDS} bands, GeoTIFF of {size_mb:.0f} MB"
    share = disk_s / taken_s
    asked = f"{size_mb / taken_s:.0f} MB/s, {100 * share:.0f} % of the disk's; asked: {100 * DISK_SHARE:.0f} %"
    told(what, taken_s, asked)
    told("as many bytes at once", disk_s, f"{size_mb / disk_s:.0f} MB/s")


def write_plainly(path: Path, size_mb: float) -> None:
    """Write so many bytes, and wait until the disk has them."""
    block = np.random.default_rng(0).bytes(10_000_000)
    with path.open("wb") as file:
        for _ in range(int(size_mb / 10)):
            file.write(block)
        file.flush()
        os.fsync(file.fileno())


def traced(folder: Path, scan: ScanOnMap, python: str) -> None:
    """Have gref4hsi trace the same rays to a mesh of the same heights; print its time and how far the places lie."""
    ground, n_lines = scan.ground, scan.shape[0]
    position, euler, _ = scan.bodies(0, n_lines)
    body = matrix_from_euler(euler)
    rows, columns = np.indices(ground.grid.shape)
    north, east = ground.corner_m[0] - rows * ground.cell_m[0], ground.corner_m[1] + columns * ground.cell_m[1]
    points = np.stack([north, east, -ground.grid.astype(float)], axis=-1).reshape(-1, 3)
    corner = np.arange(len(points)).reshape(ground.grid.shape)
    first, right, below, last = corner[:-1, :-1], corner[:-1, 1:], corner[1:, :-1], corner[1:, 1:]
    faces = np.concatenate(
        [np.stack(one, axis=-1).reshape(-1, 3) for one in ((first, right, below), (right, last, below))]
    )
    rays = pixel_directions(CAMERA, np.arange(CAMERA.n_pixels))
    np.savez(
        folder / "rays.npz",
        points=points,
        faces=faces,
        centre=position + body @ POSE[:3],
        turn=body @ scan.mounted.turn,
        rays=rays / np.linalg.norm(rays, axis=1, keepdims=True),
    )
    out = folder / "traced.npy"
    command = [python, "-c", TRACE, str(folder / "rays.npz"), str(LARGEST_RAY_M), str(out)]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        print(f"gref4hsi: {done.stderr}", file=sys.stderr)
        return
    found = scan.places(0, n_lines).place_m[::97, :, ::29].transpose(0, 2, 1)
    apart_m = np.linalg.norm(np.load(out)[..., [1, 0, 2]] * [1, 1, -1] - found, axis=-1)
    told(
        f"{CAMERA.n_pixels} x {n_lines} lines, places without sigmas by gref4hsi",
        float(done.stdout.split()[-1]),
        f"{np.median(apart_m) * 1e3:.1f} mm from ours in the median",
    )


def main() -> None:
    """Print the measurements."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--large", action="store_true", help="GeoTIFF of all lines")
    parser.add_argument("--gref4hsi", metavar="PYTHON", help="an interpreter that has gref4hsi")
    asked = parser.parse_args()
    scans = {
        "on a plane": strip(N_LINES, flat_ground(0.0)),
        "on an elevation model": strip(N_LINES, hills(N_LINES)),
        "through a bent lens": strip(N_LINES, flat_ground(0.0), BENT),
    }
    for scan in scans.values():
        scan.places(0, 2)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        paths = [places(folder, kind, scan) for kind, scan in scans.items()]
        table(folder, paths[1])
        if asked.gref4hsi:
            traced(folder, scans["on an elevation model"], asked.gref4hsi)
        geotiff(folder, paths[1], N_LINES if asked.large else N_LINES // 10)


if __name__ == "__main__":
    main()
