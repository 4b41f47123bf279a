from dataclasses import replace

import numpy as np
import pytest

from linepose.errors import InputError
from linepose.output.map.budget import ALL, budget_table
from linepose.output.map.files import written_together
from linepose.output.map.places import count_states
from linepose.output.map.platform_map import ScanMap
from linepose.output.map.rasters import ScanRasters
from linepose.output.map.sources import SOURCES
from linepose.output.map.words import budget_sentences, scan_sentence
from linepose.output.map.write_places import places_header, write_places
from unit.output.map.made_up_scan import scan


@pytest.mark.parametrize("n_cores", [1, 3])
def test_files_hold_the_places_of_all_blocks(tmp_path, n_cores):
    strip = scan(n_lines=600)
    igm, sigma = tmp_path / "igm.dat", tmp_path / "sigma.dat"
    igm.touch()
    sigma.touch()
    counts = write_places(strip, igm, sigma, n_cores)
    whole = strip.places(0, 600)
    np.testing.assert_array_equal(np.fromfile(igm).reshape(600, 3, 60), whole.place_m)
    written = np.fromfile(sigma, dtype=np.float32).reshape(600, 4, 60)
    np.testing.assert_array_equal(written, whole.sigma_m)
    assert counts == count_states(whole.state)


@pytest.mark.filterwarnings("ignore::rasterio.errors.NotGeoreferencedWarning")
def test_rasterio_reads_the_places_by_their_header(tmp_path):
    import rasterio

    strip = scan(n_lines=9)
    with written_together(tmp_path, ["a.dat", "a.hdr", "s.dat"]) as paths:
        write_places(strip, paths["a.dat"], paths["s.dat"], 1)
        paths["a.hdr"].write_text(places_header(strip))
    with rasterio.open(tmp_path / "a.dat") as file:
        np.testing.assert_array_equal(file.read().transpose(1, 0, 2), strip.places(0, 9).place_m)


def test_links_are_refused_and_a_fault_leaves_nothing(tmp_path):
    (tmp_path / "a.dat").symlink_to(tmp_path / "elsewhere")
    with pytest.raises(InputError, match=r"a\.dat: found a link"), written_together(tmp_path, ["a.dat"]):
        pass
    with pytest.raises(ValueError, match="x"), written_together(tmp_path / "new", ["a.dat"]):
        raise ValueError("x")
    assert list((tmp_path / "new").iterdir()) == []


def test_a_full_disk_is_told_in_one_line(tmp_path):
    with pytest.raises(InputError, match="a full disk"), written_together(tmp_path, ["a.dat"]):
        raise OSError(28, "No space left on device")


def test_budget_adds_up_at_centre_and_edge():
    table = budget_table(scan()).set_index(["place", "source"])["horizontal_m"].astype(float)
    for place in ("centre", "edge"):
        one_line = np.sqrt(sum(table[place, source] ** 2 for source in SOURCES))
        assert one_line == pytest.approx(table[place, ALL], rel=0.02)  # of medians over lines
    assert table["edge", ALL] > table["centre", ALL]


def test_a_map_is_told_with_its_budget_and_what_was_counted():
    counts = {"n_missed": 7, "n_outside": 0, "n_in_hole": 3, "n_met_twice": 0}
    rasters = ScanRasters(0.02, 10, 20, 60, 15, (), is_new=False)
    made = ScanMap("strip", 100, counts, budget_table(scan()), is_new=False, rasters=rasters)
    told = scan_sentence(made)
    assert "7 of 100 pixels miss the ground; 3 of 100 pixels end in a hole of it" in told
    assert (
        "15 of 75 cells of 0.02 m are filled from beside; 30 pixels are not the nearest of their cell's centre" in told
    )
    assert told.startswith("strip (made before): ")
    assert "GeoTIFF" not in told
    with_bands = replace(rasters, bands=(30, 60))
    assert scan_sentence(replace(made, rasters=with_bands)).endswith("; GeoTIFF strip.tif of the bands 30, 60")
    centre, edge = budget_sentences(made)
    whole = made.budget.set_index(["place", "source"])["horizontal_m"].astype(float) * 1000
    assert centre.startswith(
        f"  one sigma at the centre: {whole['centre', ALL]:.1f} mm; its sources, each alone: pose "
    )
    assert f"navigation {whole['edge', 'navigation']:.1f}, " in edge
