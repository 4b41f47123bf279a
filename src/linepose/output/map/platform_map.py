"""All scans of a calibrated platform on the map; a scan that was finished before is not made again."""

import hashlib
import json
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Self

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from linepose.adjustment.levels import LEVEL_NAMES, Levels
from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.inputs.navigation import log_covariances, read_navigation
from linepose.inputs.observed_points import select_scans
from linepose.inputs.scans.line_times import line_times_of
from linepose.inputs.scans.scan_files import scan_size
from linepose.inputs.source import ScansSection
from linepose.output.map.budget import BUDGET, budget_table
from linepose.output.map.files import check_target, remove_leftovers, written_together
from linepose.output.map.frame import survey_map
from linepose.output.map.ground import ground_of
from linepose.output.map.places import Navigation, ScanOnMap
from linepose.output.map.rasters import GEOTIFF_ENDING, RASTER_ENDINGS, ScanRasters, write_rasters
from linepose.output.map.sources import MountedCamera
from linepose.output.map.write_places import places_header, sigma_header, write_places
from linepose.pipeline.adjusted_schemas import CORRECTION_COLUMNS, LEVELS
from linepose.pipeline.calibration import Calibration
from linepose.pipeline.code_digest import script_digest
from linepose.survey.navigation_log import POSE_AT

if TYPE_CHECKING:
    from linepose.config.map import MapSection

_ENDINGS: Final = ("-igm.dat", "-igm.hdr", "-sigma.dat", "-sigma.hdr")
_RECORD: Final = "-map.json"


@dataclass(frozen=True, eq=False)
class ScanMap:
    """A scan that is on the map: its name, how many pixels have no place and why, and its error budget.

    `counts` by the names of STATES; `budget` has columns as in `BUDGET`; `rasters`: its lookup table and GeoTIFF.
    `is_new` unless an earlier run had made all of it.
    """

    name: str
    n_pixels: int
    counts: dict[str, int]
    budget: pd.DataFrame
    is_new: bool
    rasters: ScanRasters | None = None


@dataclass(frozen=True, eq=False)
class PlatformMap:
    """What the maps of all scans of a platform have in common; `scan` is without times, name and correction."""

    scan: ScanOnMap
    paths: dict[int, Path]
    calibration: Calibration
    source: ScansSection
    section: "MapSection"

    def scan_on_map(self, number: int) -> ScanOnMap:
        """What the places of the scan of an observation rest on; raises InputError where its times are not known."""
        path, n_pixels = self.paths[number], self.scan.mounted.camera.n_pixels
        lines, pixels = scan_size(path)
        if pixels != n_pixels:
            remedy = "correct camera.n_pixels, or use the calibration of this scan's camera"
            raise InputError(str(path), f"{pixels} pixels", f"{n_pixels}, as the camera that was calibrated", remedy)
        times = line_times_of(self.source)(path, lines)
        self.scan.navigation.check(times, str(path))
        return replace(self.scan, name=path.stem, time_us=times, correction=self._correction(number))

    def part(self, share: range) -> Self:
        """The map of the scans of these consecutive numbers alone."""
        return replace(self, paths=dict(list(self.paths.items())[share.start : share.stop]))

    def _correction(self, number: int) -> Floats:
        """What the adjustment added to the body's poses in an observation; zero where the pose is of no adjustment."""
        if not self.calibration.is_adjusted:
            return np.zeros(6)
        views = self.calibration.adjusted_views
        rows = views.loc[views["observation"] == number, list(CORRECTION_COLUMNS)].to_numpy(dtype=float)
        return np.nan_to_num(rows[0]) if len(rows) else np.zeros(6)


def platform_map(calibration: Calibration, section: "MapSection", folder: Path) -> PlatformMap:
    """The map of a platform whose data stand in a folder; raises InputError where it has no scans."""
    platform = calibration.platform_file
    source = platform.source
    if not isinstance(source, ScansSection):
        found = "labelled views, which have no scans"
        raise InputError(f"{calibration.name}.yaml: source", found, "scans", "map a platform whose source is scans")
    settings = platform.navigation
    record = read_navigation(source, folder, settings.corrections)
    navigation = Navigation(
        record.log,
        POSE_AT[settings.association],
        log_covariances(record, source, settings.covariance_columns, folder, settings.corrections),
        settings.maximum_pose_gap_s,
        settings.maximum_gap_s,
    )
    mounted = MountedCamera(
        calibration.own_camera,
        calibration.pose,
        calibration.covariance,
        _levels(calibration),
        calibration.intrinsics,
    )
    frame = survey_map(calibration)
    ground = ground_of(calibration, section, frame, folder)
    scan = ScanOnMap("", np.empty(0, dtype=np.int64), mounted, navigation, ground, frame, np.zeros(6))
    paths = select_scans(folder, source.scans, source.left_out)
    _check_names(paths)
    return PlatformMap(scan, paths, calibration, source, section)


def _check_names(paths: dict[int, Path]) -> None:
    """Raise InputError where two scans, whose files are named as they are, have one name."""
    known: dict[str, Path] = {}
    for path in paths.values():
        if path.stem in known:
            found, expected = f"a scan of the name of {known[path.stem]}", "scans of different names"
            raise InputError(str(path), found, expected, "rename one of them")
        known[path.stem] = path


def write_maps(platform: PlatformMap, output: Path, n_cores: int = 1) -> Iterator[ScanMap]:
    """Write each scan's files into a folder, and tell it when it is done.

    A scan whose files stand there already, made of the same numbers by the same code, is passed over. Raises InputError
    for what cannot be used, before anything of that scan is written.
    """
    common = _digest(platform.scan)
    for number in platform.paths:
        scan, path = platform.scan_on_map(number), platform.paths[number]
        digest = hashlib.sha256(common.encode() + scan.time_us.tobytes() + scan.correction.tobytes()).hexdigest()
        made = _write_scan(scan, output, digest, n_cores)
        rasters = write_rasters(path, scan.shape, scan.frame, platform.section, output, digest, n_cores)
        yield replace(made, rasters=rasters, is_new=made.is_new or rasters.is_new)


def files_of(made: ScanMap) -> list[str]:
    """Names of all files of a scan's map, sorted."""
    endings = [*_ENDINGS, _RECORD]
    if made.rasters is not None and made.rasters.n_rows:
        endings += [*RASTER_ENDINGS, *([GEOTIFF_ENDING] if made.rasters.bands else [])]
    return sorted(f"{made.name}{ending}" for ending in endings)


def _write_scan(scan: ScanOnMap, output: Path, digest: str, n_cores: int) -> ScanMap:
    names = [f"{scan.name}{ending}" for ending in _ENDINGS]
    record = output / f"{scan.name}{_RECORD}"
    finished = _finished(record, [output / name for name in names], digest)
    if finished is not None:
        return finished
    check_target(record)
    record.unlink(missing_ok=True)  # until all is written nothing says that it is
    remove_leftovers(output, [*names, record.name])
    with written_together(output, [*names, record.name]) as paths:
        igm, igm_header, sigma, sigma_header_ = (paths[name] for name in names)
        counts = write_places(scan, igm, sigma, n_cores)
        igm_header.write_text(places_header(scan), encoding="utf-8")
        sigma_header_.write_text(sigma_header(scan), encoding="utf-8")
        made = ScanMap(scan.name, scan.shape[0] * scan.shape[1], counts, budget_table(scan), is_new=True)
        paths[record.name].write_text(_record_text(made, digest), encoding="utf-8")
    return made


def _record_text(made: ScanMap, digest: str) -> str:
    rows = made.budget.astype(object).where(made.budget.notna(), None).to_dict(orient="records")
    values = {"scan": made.name, "made_of": digest, "n_pixels": made.n_pixels, "counts": made.counts, "budget": rows}
    return json.dumps(values, indent=1) + "\n"


def _finished(record: Path, files: list[Path], digest: str) -> ScanMap | None:
    """What an earlier run has made of the same numbers; None where it has not, or a file is gone."""
    if record.is_symlink() or not record.is_file() or not all(path.is_file() for path in files):
        return None
    try:
        values: dict[str, Any] = json.loads(record.read_text(encoding="utf-8"))
        if values["made_of"] != digest:
            return None
        budget = pd.DataFrame(values["budget"], columns=BUDGET.names)
        return ScanMap(values["scan"], values["n_pixels"], values["counts"], budget, is_new=False)
    except (ValueError, KeyError, TypeError):
        return None


def _digest(scan: ScanOnMap) -> str:
    """Digest of all that the places of every scan rest on, and of the code that makes them."""
    mounted, log, reported, ground = scan.mounted, scan.navigation.log, scan.navigation.reported, scan.ground
    words = [
        mounted.camera.model_dump_json(),
        repr(mounted.levels),
        repr(scan.frame),
        scan.navigation.pose_at.__name__,
        script_digest(__file__),
        repr((ground.sigma_m, ground.offset, ground.corner_m, ground.cell_m)),
    ]
    arrays: list[NDArray[Any]] = [
        mounted.pose,
        mounted.covariance,
        mounted.intrinsics_covariance,
        mounted.with_intrinsics,
        log.time_us,
        log.position_m,
        log.euler_rad,
    ]
    arrays += [reported.time_us, reported.covariance, ground.normal, ground.grid]
    whole = hashlib.sha256()
    for part in (*(word.encode() for word in words), *(np.ascontiguousarray(one).tobytes() for one in arrays)):
        whole.update(hashlib.sha256(part).digest())
    return whole.hexdigest()


def _levels(calibration: Calibration) -> Levels | None:
    """The scales that an adjustment found; None where the pose is not one's."""
    if not calibration.is_adjusted:
        return None
    table = calibration.results.table("levels", LEVELS).set_index("level")["value"]
    return Levels(*(float(table[name]) for name in LEVEL_NAMES))
