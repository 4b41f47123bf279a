"""Lookup table and GeoTIFF of a scan that has its places; one that was finished before is not made again."""

import hashlib
import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.inputs.scans.envi_data import open_envi
from linepose.inputs.scans.scan_bands import ScanBands, open_bands
from linepose.output.map.files import check_target, remove_leftovers, written_together
from linepose.output.map.frame import SurveyMap
from linepose.output.map.geotiff import Layers, write_geotiff
from linepose.output.map.glt import glt_header, write_glt
from linepose.output.map.lattice import lattice_of
from linepose.output.map.places import N_PLACE

if TYPE_CHECKING:
    from linepose.config.map import MapSection

_RECORD: Final = "-glt.json"
RASTER_ENDINGS: Final = ("-glt.dat", "-glt.hdr", _RECORD)
GEOTIFF_ENDING: Final = ".tif"


@dataclass(frozen=True)
class ScanRasters:
    """Cells of a scan's maps: their size (m) and how many, of them with a pixel of their own, and filled from beside.

    Without a place on the ground the scan has none, and no file. `is_new` unless an earlier run had made them.
    """

    cell_m: float
    n_rows: int
    n_columns: int
    n_cells: int
    n_filled: int
    bands: tuple[int, ...]
    is_new: bool


def write_rasters(
    path: Path,
    shape: tuple[int, int],
    frame: SurveyMap,
    section: "MapSection",
    output: Path,
    made_of: str,
    n_cores: int,
) -> ScanRasters:
    """Write a scan file's lookup table and, if asked for, its GeoTIFF, into the folder of its IGM of lines and pixels.

    `made_of`: digest of all that the IGM rests on. Raises InputError before anything is written.
    """
    name = path.stem
    scan = None if section.geotiff is None else open_bands(path)
    layers = None if scan is None else _layers(section, scan, path)
    names = [f"{name}-glt.dat", f"{name}-glt.hdr"] + ([f"{name}.tif"] if layers else [])
    record = output / f"{name}{_RECORD}"
    digest = hashlib.sha256(
        repr((made_of, section.cell_m, layers, _contents(path) if layers else [])).encode()
    ).hexdigest()
    finished = _finished(record, [output / one for one in names], digest)
    if finished is not None:
        return finished
    check_target(record)
    record.unlink(missing_ok=True)
    remove_leftovers(output, [*names, record.name])
    for stale in (
        f"{name}-glt.dat",
        f"{name}-glt.hdr",
        f"{name}.tif",
    ):  # of another pose or bands
        if not (output / stale).is_symlink():  # a link is refused where it is to be written
            (output / stale).unlink(missing_ok=True)
    igm: Floats = np.memmap(output / f"{name}-igm.dat", dtype="<f8", mode="r", shape=(shape[0], N_PLACE, shape[1]))
    lattice = lattice_of(igm, section.cell_m, str(path), n_cores)
    if lattice is None:
        return ScanRasters(section.cell_m or 0.0, 0, 0, 0, 0, (), is_new=True)
    with written_together(output, [*names, record.name]) as paths:
        counts = write_glt(igm, lattice, paths[names[0]], n_cores)
        paths[names[1]].write_text(glt_header(lattice, frame, name), encoding="utf-8")
        if scan is not None and layers is not None:
            write_geotiff(igm, lattice, frame, scan, layers, paths[names[2]], n_cores)
        bands = layers.bands if layers else ()
        made = ScanRasters(lattice.cell_m, lattice.n_rows, lattice.n_columns, **counts, bands=bands, is_new=True)
        paths[record.name].write_text(_record_text(made, digest), encoding="utf-8")
    return made


def _layers(section: "MapSection", scan: ScanBands, path: Path) -> Layers:
    assert section.geotiff is not None
    n_bands, wanted = scan.shape[2], section.geotiff.bands
    bands = tuple(range(1, n_bands + 1)) if wanted == "all" else tuple(wanted)
    unknown = [band for band in bands if band > n_bands]
    if unknown:
        remedy = "correct map.geotiff.bands, or --bands"
        raise InputError(str(path), f"no band {unknown[0]}", f"bands from 1 to {n_bands}", remedy)
    return Layers(bands, section.geotiff.resampling, section.geotiff.compression)


def _contents(path: Path) -> list[str]:
    """Digests of a scan's files."""
    digests = []
    for name in [path, open_envi(path).path] if path.suffix.lower() == ".hdr" else [path]:
        with name.open("rb") as file:
            digests.append(hashlib.file_digest(file, "sha256").hexdigest())
    return digests


def _record_text(made: ScanRasters, digest: str) -> str:
    values = {key: value for key, value in vars(made).items() if key != "is_new"}
    return json.dumps({"made_of": digest, **values}, indent=1) + "\n"


def _finished(record: Path, files: list[Path], digest: str) -> ScanRasters | None:
    """What an earlier run has made of the same numbers; None where it has not, or a file is gone."""
    if record.is_symlink() or not record.is_file() or not all(path.is_file() for path in files):
        return None
    try:
        values: dict[str, Any] = json.loads(record.read_text(encoding="utf-8"))
        if values.pop("made_of") != digest:
            return None
        return ScanRasters(**{**values, "bands": tuple(values["bands"])}, is_new=False)
    except (ValueError, KeyError, TypeError):
        return None
