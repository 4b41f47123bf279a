"""Lookup table and GeoTIFF of a scan: what rasterio reads back of them lies where the scan's places are."""

import numpy as np
import pytest
import rasterio
import tifffile

from linepose.config.map import GeotiffSection, MapSection
from linepose.errors import InputError
from linepose.output.exports.map_frame import MapFrame
from linepose.output.map.frame import SurveyMap
from linepose.output.map.lattice import lattice_of
from linepose.output.map.lookup import look_up
from linepose.output.map.rasters import write_rasters
from unit.output.map.made_up_scan import ORIGIN, scan

LINES, PIXELS, BANDS = 150, 60, 5
MAP = SurveyMap(MapFrame("EPSG:32756"))
pytestmark = pytest.mark.filterwarnings("ignore::rasterio.errors.NotGeoreferencedWarning")


@pytest.fixture(scope="module")
def places():
    """Places (L, 3, P) of a strip that winds over the ground."""
    return scan(n_lines=LINES).places(0, LINES).place_m


def write_scan(folder, interleave="bil", dtype=np.uint16, kind=12, order=0):
    """An ENVI scan whose value at line, band, pixel is 1000 + 100 band + line + 2 pixel, and its header's path."""
    line, band, pixel = np.meshgrid(np.arange(LINES), np.arange(BANDS), np.arange(PIXELS), indexing="ij")
    values = 1000 + 100 * band + line + 2 * pixel
    axes = {"bil": (0, 1, 2), "bip": (0, 2, 1), "bsq": (1, 0, 2)}[interleave]
    values.transpose(axes).astype(np.dtype(dtype).newbyteorder("<>"[order])).tofile(folder / "strip.raw")
    header = folder / "strip.hdr"
    header.write_text(
        f"ENVI\nsamples = {PIXELS}\nlines = {LINES}\nbands = {BANDS}\nheader offset = 0\nfile type = ENVI Standard\n"
        f"data type = {kind}\ninterleave = {interleave}\nbyte order = {order}\n"
    )
    return header


def made(folder, places, section, cores=1, frame=MAP, made_of="these places", **scan_of):
    """What is written of the scan into a folder."""
    folder.mkdir(exist_ok=True)
    header = folder.parent / "strip.hdr"
    if not header.exists():
        write_scan(folder.parent, **scan_of)
    places.tofile(folder / "strip-igm.dat")
    return write_rasters(header, (LINES, PIXELS), frame, section, folder, made_of, cores)


def cells_of(places, lattice_m, east, north):
    """Row and column of each place."""
    return np.floor((north - places[:, 1]) / lattice_m).astype(int), np.floor((places[:, 0] - east) / lattice_m).astype(
        int
    )


@pytest.mark.parametrize("cell_m", [None, 0.02, 0.5])
def test_each_cell_names_the_pixel_that_lies_nearest_to_its_centre(tmp_path, places, cell_m):
    done = made(tmp_path / "map", places, MapSection(cell_m=cell_m))
    with rasterio.open(tmp_path / "map" / "strip-glt.dat") as file:
        sample, line = file.read()
        transform, crs = file.transform, file.crs
    assert crs.to_epsg() == 32756
    cell = transform.a
    assert cell == -transform.e == done.cell_m
    row, column = cells_of(places, cell, transform.c, transform.f)
    off = np.hypot(places[:, 0] - transform.c - (column + 0.5) * cell, places[:, 1] - transform.f + (row + 0.5) * cell)
    best = np.full(sample.shape, np.inf)
    np.minimum.at(best, (row, column), off)
    has_pixel = np.isfinite(best)
    assert np.array_equal(sample > 0, has_pixel)
    assert np.array_equal(line > 0, has_pixel)
    assert done.n_cells == has_pixel.sum()
    at = line[has_pixel] - 1, sample[has_pixel] - 1
    np.testing.assert_allclose(off[at], best[has_pixel], atol=1e-9)
    np.testing.assert_array_equal(np.stack([row[at], column[at]]), np.nonzero(has_pixel))
    assert done.n_filled == (sample < 0).sum() == (line < 0).sum()
    rows, columns = np.nonzero(sample < 0)
    beside = places[-line[rows, columns] - 1, :2, -sample[rows, columns] - 1]
    centre = np.stack([transform.c + (columns + 0.5) * cell, transform.f - (rows + 0.5) * cell], axis=-1)
    assert np.all(np.linalg.norm(beside - centre, axis=1) < 0.11)  # pixels are at most 0.15 m apart
    assert (len(rows) > has_pixel.sum()) == (cell_m == 0.02)


@pytest.mark.parametrize(
    ("interleave", "kind", "dtype", "order"), [("bil", 12, "u2", 0), ("bip", 4, "f4", 1), ("bsq", 2, "i2", 1)]
)
def test_a_geotiff_holds_the_values_of_the_nearest_pixels(tmp_path, places, interleave, kind, dtype, order):
    section = MapSection(cell_m=0.05, geotiff=GeotiffSection(bands=[4, 2]))
    made(tmp_path / "map", places, section, interleave=interleave, kind=kind, dtype=dtype, order=order)
    with (
        rasterio.open(tmp_path / "map" / "strip-glt.dat") as table,
        rasterio.open(tmp_path / "map" / "strip.tif") as file,
    ):
        sample, line = np.abs(table.read())
        assert (file.transform, file.crs.to_epsg()) == (table.transform, 32756)
        assert file.profile["tiled"]
        assert file.descriptions == ("band 4", "band 2")
        bands, seen = file.read(), file.read_masks(1) > 0
    assert np.array_equal(seen, line > 0)
    for values, band in zip(bands, (3, 1), strict=True):
        expected = 1000 + 100 * band + (line - 1) + 2 * (sample - 1)
        np.testing.assert_array_equal(values[seen], expected[seen])


@pytest.mark.parametrize("compression", ["none", "deflate"])
def test_a_geotiff_is_cloud_optimised(tmp_path, places, compression):
    """All directories stand before all data, and overviews' data before the whole image's, in tiles."""
    section = MapSection(cell_m=0.008, geotiff=GeotiffSection(bands=[1, 3], compression=compression))
    made(tmp_path / "map", places, section)
    with tifffile.TiffFile(tmp_path / "map" / "strip.tif") as file:
        pages = [(page.offset, [offset for offset in page.dataoffsets if offset]) for page in file.pages]
        assert all(page.is_tiled for page in file.pages)
    directories, data = zip(*pages, strict=True)
    assert len(pages) == 2
    assert list(directories) == sorted(directories)
    assert directories[-1] < min(data[1])
    assert max(data[1]) < min(data[0])


def test_bilinear_values_are_those_of_the_cells_centres(tmp_path, places):
    """A scan whose light is linear in the map's own coordinates keeps it, to what the strip's bends are."""
    header = write_scan(tmp_path, kind=4, dtype="f4")
    light = 3 * (places[:, 0] - ORIGIN[1]) + 2 * (places[:, 1] - ORIGIN[0])
    np.repeat(light[:, None], BANDS, axis=1).astype("<f4").tofile(tmp_path / "strip.raw")
    places.tofile(tmp_path / "strip-igm.dat")
    section = MapSection(cell_m=0.03, geotiff=GeotiffSection(bands=[1], resampling="bilinear"))
    write_rasters(header, (LINES, PIXELS), MAP, section, tmp_path, "x", 1)
    with rasterio.open(tmp_path / "strip.tif") as file, rasterio.open(tmp_path / "strip-glt.dat") as table:
        values, transform = file.read(1), file.transform
        line = np.abs(table.read(2))
    rows, columns = np.nonzero((line > 3) & (line < LINES - 3) & np.isfinite(values))
    east, north = transform.c + (columns + 0.5) * 0.03, transform.f - (rows + 0.5) * 0.03
    off = values[rows, columns] - 3 * (east - ORIGIN[1]) - 2 * (north - ORIGIN[0])
    assert len(off) > 1000
    assert np.quantile(np.abs(off), 0.9) < 0.004  # a cell's half is 0.07


def test_any_number_of_cores_writes_the_same_bytes(tmp_path, places):
    section = MapSection(cell_m=0.01, geotiff=GeotiffSection(bands="all", compression="deflate"))
    files = []
    for cores in (1, 3):
        made(tmp_path / f"map{cores}", places, section, cores)
        files.append({path.name: path.read_bytes() for path in (tmp_path / f"map{cores}").iterdir()})
    assert files[0] == files[1]
    assert set(files[0]) == {"strip-igm.dat", "strip-glt.dat", "strip-glt.hdr", "strip-glt.json", "strip.tif"}


def test_tiles_do_not_show(places):
    whole = lattice_of(places, 0.02, "strip", 1)
    chunks = whole.chunks_of_tiles(1000)
    assert list(chunks) == [(0, 0)]
    at_once = look_up(places, whole, (0, 0), 1000, chunks[0, 0], exactly=True)
    for (row, column), some in whole.chunks_of_tiles(50).items():
        part = look_up(places, whole, (row, column), 50, some, exactly=True)
        cells = np.s_[row * 50 : row * 50 + 50, column * 50 : column * 50 + 50]
        np.testing.assert_array_equal(part.line, at_once.line[cells])
        np.testing.assert_array_equal(part.pixel, at_once.pixel[cells])
        np.testing.assert_allclose(part.between, at_once.between[:, *cells], atol=1e-6)


def test_pixels_without_a_place_and_a_gap_between_lines_leave_holes(tmp_path, places):
    holed = places.copy()
    holed[60:70, :, 20:30] = np.nan
    holed[100:] += np.array([30.0, 0.0, 0.0])[:, None]
    made(tmp_path / "map", holed, MapSection(cell_m=0.05), frame=SurveyMap(None))
    with rasterio.open(tmp_path / "map" / "strip-glt.dat") as file:
        sample, line = np.abs(file.read())
        transform = file.transform
    east, north = holed[[99, 100], :2, 30].mean(axis=0)  # between what lies on either side of the gap
    row, column = int((transform.f - north) / 0.05), int((east - transform.c) / 0.05)
    assert line[row, column] == 0
    inside = (line > 62) & (line < 69) & (sample > 22) & (sample < 29)
    assert not inside.any()


def test_what_is_finished_is_passed_over_until_something_changes(tmp_path, places):
    section = MapSection(cell_m=0.1)
    assert made(tmp_path / "map", places, section).is_new
    again = made(tmp_path / "map", places, section)
    assert not again.is_new
    assert again.n_cells > 0
    assert made(tmp_path / "map", places, MapSection(cell_m=0.2)).is_new
    assert made(tmp_path / "map", places, MapSection(cell_m=0.2), made_of="others").is_new
    (tmp_path / "map" / "strip-glt.dat").unlink()
    (tmp_path / "map" / ".abcdefgh-strip-glt.dat").write_text("half")
    assert made(tmp_path / "map", places, MapSection(cell_m=0.2), made_of="others").is_new
    assert not list((tmp_path / "map").glob(".*"))


def test_what_cannot_be_written_is_told_before_anything_is(tmp_path, places):
    folder = tmp_path / "map"
    with pytest.raises(InputError, match=r"strip\.hdr: found no band 6, expected bands from 1 to 5"):
        made(folder, places, MapSection(geotiff=GeotiffSection(bands=[1, 6])))
    with pytest.raises(InputError, match=r"found a map of .* cells of 1e-05 m, .*write map\.cell_m: [\d.e-]+ or more"):
        made(folder, places, MapSection(cell_m=1e-5))
    (folder / "strip.tif").symlink_to(tmp_path / "elsewhere")
    with pytest.raises(InputError, match=r"strip\.tif: found a link"):
        made(folder, places, MapSection(cell_m=0.1, geotiff=GeotiffSection(bands=[1])))
    assert sorted(path.name for path in folder.iterdir()) == ["strip-igm.dat", "strip.tif"]
    assert not (tmp_path / "elsewhere").exists()


def test_a_full_disk_leaves_nothing(tmp_path, places, monkeypatch):
    monkeypatch.setattr("linepose.output.map.geotiff.shutil.disk_usage", lambda _: type("Usage", (), {"free": 1000}))
    with pytest.raises(InputError, match="found a full disk"):
        made(tmp_path / "map", places, MapSection(cell_m=0.1, geotiff=GeotiffSection(bands=[1])))
    assert [path.name for path in (tmp_path / "map").iterdir()] == ["strip-igm.dat"]


def test_a_scan_without_any_place_has_no_map(tmp_path, places):
    nowhere = np.full_like(places, np.nan)
    assert made(tmp_path / "map", nowhere, MapSection()).n_rows == 0
