"""The tiny survey as devices and other tools would have recorded it, run by the workflow up to the observations."""

import json
import sys

import numpy as np
import pandas as pd
import pytest
from tiny_project import ROOT, STUDY, TINY

from linepose.survey.observations import COVARIANCE_COLUMNS, COVARIANCE_INDICES, EULER_COLUMNS, POSITION_COLUMNS

sys.path.insert(0, str(ROOT / "tests"))
from unit.inputs import novatel_writer, writers
from unit.inputs.drive import ORIGIN, drive_of

pytestmark = pytest.mark.workflow


def scans_of(simulated, folder, number):
    """A scan's header and data under other names, and its time stamps."""
    for ending in ("bil", "hdr"):
        (folder / f"raw_{number}.{ending}").write_bytes(
            (simulated / "scans" / f"observation-{number:02d}.{ending}").read_bytes()
        )
    return pd.read_csv(simulated / "scans" / f"observation-{number:02d}-times.csv")["time_us"].to_numpy()


def write_headwall(simulated, folder, number):
    times = scans_of(simulated, folder, number)
    rows = [f"{frame}\t{time}" for frame, time in enumerate(times)]
    (folder / f"frameIndex_{number}.txt").write_text("\n".join(["Frame#\tTimestamp", *rows]))


def write_resonon(simulated, folder, number):
    times = scans_of(simulated, folder, number)
    gps_s = (times[0] - 315_964_800_000_000 + 17_000_000) / 1e6
    (folder / f"raw_{number}.lcf").write_text(f"{gps_s:.6f} 0 0 0 151 -33 42 0 0 5\n")
    (folder / f"raw_{number}.times").write_text("\n".join(f"{(time - times[0]) / 1e6:.6f}" for time in times))


def write_labelme(labels, folder):
    for number, mine in labels.groupby("observation"):
        shapes = [
            {"label": f"point {row.point}", "points": [[row.u_px + 0.5, row.line + 0.5]], "shape_type": "point"}
            for row in mine.itertuples()
        ]
        n_lines = len((folder / f"frameIndex_{number}.txt").read_text().splitlines()) - 1  # below its heading
        size = {"imageWidth": 648, "imageHeight": n_lines}
        content = {"shapes": shapes, "imagePath": f"raw_{number}.png", **size}
        (folder / f"raw_{number}.json").write_text(json.dumps(content))


def write_cvat(labels, path):
    images = []
    for number, mine in labels.groupby("observation"):
        points = [
            f'<points label="{row.point}" points="{row.u_px + 0.5:.4f},{row.line + 0.5:.4f}"/>'
            for row in mine.itertuples()
        ]
        images.append(f'<image name="raw_{number}.png" width="648">{"".join(points)}</image>')
    path.write_text(f"<annotations>{''.join(images)}</annotations>")


@pytest.fixture
def recorded(copied):
    """A project with the tiny survey, recorded by three kinds of devices, and their navigation as a drive."""
    project = copied
    simulated = project.folder / "results" / "tiny" / "simulated"
    labels = pd.read_csv(simulated / "labels.csv")
    sigma = np.sqrt(np.loadtxt(simulated / "covariances.csv", delimiter=",")[0, 1:].reshape(12, 12).diagonal()[:6])
    drive = drive_of(pd.read_parquet(simulated / "navigation.parquet"), np.diag(sigma**2))
    for name in ("novatel", "sbet", "rosbag"):
        folder = project.folder / "data" / name / "scans"
        folder.mkdir(parents=True)
        for number in range(1, 5):
            (write_resonon if name == "sbet" else write_headwall)(simulated, folder, number)
    data = project.folder / "data"
    write_labelme(labels, data / "novatel" / "scans")
    write_cvat(labels, data / "sbet" / "labels.xml")
    labels.to_csv(data / "rosbag" / "labels.csv", index=False)
    messages = [
        novatel_writer.pva("INSPVAS", drive, row, True)
        + (novatel_writer.stdev(drive, row, True) if row % 10 == 0 else b"")
        for row in range(len(drive.time_us))
    ]
    (data / "novatel" / "run-1.gps").write_bytes(b"".join(messages[:1000]))
    (data / "novatel" / "run-2.gps").write_bytes(b"".join(messages[1000:]))
    writers.write_sbet(data / "sbet" / "sbet.out", drive)
    writers.write_rms(data / "sbet" / "smrmsg.out", drive)
    matrix = np.swapaxes(drive.turn, -1, -2) @ drive.true_matrix
    quaternion = writers.enu_flu_quaternion(matrix)
    covariance = writers.fixed_axes_covariance(drive.euler_rad, drive.covariance, matrix)
    with writers.Bag(data / "rosbag" / "drive", 2) as bag:
        for row, time in enumerate(drive.time_us):
            enu = writers.NED_FROM_ENU.T @ drive.position_m[row]
            bag.odometry("/odometry", time, enu, quaternion[row], covariance[row])
    return project, drive


def platform(name, navigation, **source):
    return TINY | {
        "simulation": None,
        "source": {"kind": "scans", "dataset": name, "navigation": {"format": name, **navigation}, **source},
    }


def test_device_files_give_the_observations_of_the_simulation(recorded):
    project, drive = recorded
    platforms = {
        "tiny": TINY,
        "novatel": platform(
            "novatel", {"file": "run-*.gps", "origin": ORIGIN}, time_stamps="headwall", labels="scans/*.json"
        ),
        "sbet": platform(
            "sbet",
            {"file": "sbet.out", "rms": "smrmsg.out", "origin": ORIGIN},
            time_stamps="resonon",
            labels="labels.xml",
        ),
        "rosbag": platform("rosbag", {"file": "drive"}, time_stamps="headwall"),
    }
    project.configure(STUDY | {"platforms": list(platforms)}, platforms)
    wanted = [f"results/{name}/observations.parquet" for name in platforms]
    run = project.run(*wanted)
    assert run.returncode == 0, run.stderr
    ours, *others = [pd.read_parquet(project.folder / path) for path in wanted]
    shift = drive.position_m[0] - pd.read_parquet(
        project.folder / "results" / "tiny" / "simulated" / "navigation.parquet"
    ).loc[0, list(POSITION_COLUMNS)].to_numpy(dtype=float)
    sigma = np.sqrt(np.diagonal(drive.covariance[0]))
    scale = np.array([sigma[i] * sigma[j] for i, j in COVARIANCE_INDICES])
    for other in others:
        assert list(other[["observation", "point", "time_us"]].itertuples(index=False)) == list(
            ours[["observation", "point", "time_us"]].itertuples(index=False)
        )
        np.testing.assert_allclose(other["u_px"], ours["u_px"], atol=1e-9)
        np.testing.assert_allclose(
            other[list(POSITION_COLUMNS)] - shift, ours[list(POSITION_COLUMNS)], rtol=0, atol=1e-7
        )
        np.testing.assert_allclose(other[list(EULER_COLUMNS)], ours[list(EULER_COLUMNS)], rtol=0, atol=1e-10)
        # single precision; true north, about which devices report, turns by 1e-6 rad over the survey; eight digits
        ratio = (other[list(COVARIANCE_COLUMNS)] - ours[list(COVARIANCE_COLUMNS)]) / scale
        np.testing.assert_allclose(ratio, 0, atol=2e-5)
