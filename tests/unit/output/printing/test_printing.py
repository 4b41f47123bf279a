"""The print of a target, measured in its PDF, and what a person is told."""

import re
import zlib

import numpy as np
import pytest
import yaml
from typer.testing import CliRunner

from linepose.cli.app import app
from linepose.config.target_file import read_target
from linepose.survey.targets.registry import PRINTED

MM_PER_POINT = 25.4 / 72


def run(*arguments):
    return CliRunner().invoke(app, ["target", *arguments])


def followed(arguments, advice):
    """The run of what was given with the options of an advice behind it as printed, less what it says to leave out."""
    options, given = advice.removesuffix(" (and leave --paper out)"), list(arguments)
    if options != advice:
        place = given.index("--paper")
        given[place : place + 2] = []
    return run(*given, *options.split())


def pages_of(path):
    """Width and height (mm) and the drawing operators of each page."""
    data = path.read_bytes()
    boxes = [
        np.array(box.split(), dtype=float)[2:] * MM_PER_POINT for box in re.findall(rb"/MediaBox \[ (.*?) \]", data)
    ]
    streams = re.findall(rb"stream\r?\n(.*?)\r?\nendstream", data, re.DOTALL)
    texts = []
    for stream in streams:
        try:
            text = zlib.decompress(stream).decode("latin-1")
        except zlib.error:
            continue
        if text.startswith("/DeviceRGB"):
            texts.append(text)
    return boxes, texts


def filled_boxes(text):
    """Left, bottom, right, top (mm) and number of curves of every closed path, in the order of painting; (K, 5)."""
    found = [(0.0,) * 5]
    for path in re.findall(r"^[\d. -]+ m\n(?:[\d. -]+ [lc]\n)+h", text, re.MULTILINE):
        rows = path.splitlines()[:-1]
        xy = np.array([row[:-2].split() for row in rows if row[-1] != "c"], dtype=float)
        curves = np.array([row[:-2].split() for row in rows if row[-1] == "c"], dtype=float).reshape(-1, 2)
        xy = np.concatenate([xy, curves]) * MM_PER_POINT
        found.append((*xy.min(axis=0), *xy.max(axis=0), len(curves) // 3))
    return np.array(found)


def test_papers_board_is_true_to_a_tenth_of_a_millimetre(tmp_path):
    board = tmp_path / "board.pdf"
    assert run("--output", str(board)).exit_code == 0
    boxes, texts = pages_of(board)
    np.testing.assert_allclose(boxes, [[841, 594], [210, 297]], atol=0.01)
    drawn = filled_boxes(texts[0])
    discs = drawn[drawn[:, 4] >= 4]
    centre, diameter = (discs[:, :2] + discs[:, 2:4]) / 2, discs[:, 2] - discs[:, 0]
    target = PRINTED["rings"]()
    place = target.points()[:, :2] * [1e3, -1e3] + [420.5, 297]
    dots = centre[np.abs(diameter - 10) < 0.1]
    np.testing.assert_allclose(dots, place, atol=0.02)
    np.testing.assert_allclose(np.unique(diameter.round(1)), [10, 75, 120])


@pytest.mark.parametrize("kind", PRINTED)
def test_every_kind_prints_its_points_and_describes_itself(tmp_path, kind):
    path = tmp_path / "target.pdf"
    ran = run("--kind", kind, "--output", str(path))
    assert ran.exit_code == 0, ran.output
    target = read_target(tmp_path / "target.yaml")
    assert target == PRINTED[kind]()
    drawn = filled_boxes(pages_of(path)[1][0])
    edges = np.unique(np.concatenate([drawn[:, [0, 1]], drawn[:, [2, 3]], (drawn[:, :2] + drawn[:, 2:4]) / 2]), axis=0)
    place = target.points()[:, :2] * [1e3, -1e3] + [420.5, 297]
    apart = np.linalg.norm(place[:, None] - edges, axis=-1).min(axis=1)
    corners = np.concatenate([drawn[:, [0, 3]], drawn[:, [2, 1]]])
    apart = np.minimum(apart, np.linalg.norm(place[:, None] - corners, axis=-1).min(axis=1))
    assert apart.max() < 0.05


def test_tiles_carry_on_where_the_last_one_ends(tmp_path):
    path = tmp_path / "tiles.pdf"
    ran = run("--kind", "dots", "--rows", "4", "--columns", "6", "--tile", "A4", "--output", str(path))
    assert "wrote" in ran.output
    boxes, texts = pages_of(path)
    n_sheets = int(re.search(r"(\d+) sheets", ran.output)[1])
    assert len(boxes) == n_sheets + 1 == 3
    shown = boxes[0][0] - 2 * 9 - 10  # of a sheet, up to where the next one begins
    places = []
    for column, text in enumerate(texts[:n_sheets]):
        discs = filled_boxes(text)
        discs = discs[discs[:, 4] >= 4]
        places.append((discs[:, 0] + discs[:, 2]) / 2 + column * shown)
    places = np.unique(np.concatenate(places).round(1))
    np.testing.assert_allclose(places - places[0], 60.0 * np.arange(6), atol=0.1)


@pytest.mark.parametrize(
    "arguments",
    [
        ("--kind", "chessboard", "--rows", "5", "--columns", "6", "--paper", "A5"),
        ("--rows", "2", "--columns", "3", "--paper", "A3"),
        ("--spacing-mm", "200"),
    ],
)
def test_what_does_not_fit_is_refused_with_what_does(tmp_path, arguments):
    place = ("--output", str(tmp_path / "t.pdf"))
    ran = run(*arguments, *place)
    assert ran.exit_code == 1
    (told,) = ran.output.strip().splitlines()
    assert not list(tmp_path.iterdir())
    advice = told.partition("; give ")[2].split(" or ")
    assert [followed((*arguments, *place), one).exit_code for one in advice] == [0] * len(advice)
    assert ("leave --paper out" in told) == ("--paper" in arguments)
    assert advice[0].startswith("--spacing-mm")
    larger = str(int(advice[0].split()[1]) + 1)
    assert run(*arguments, "--spacing-mm", larger, *place).exit_code == 1


def test_dots_too_small_for_the_range_are_told_with_the_spacing_that_does(tmp_path):
    place = ("--output", str(tmp_path / "t.pdf"), "--paper", "5000x5000")
    ran = run("--kind", "charuco", "--range-m", "6", "--pixel-mrad", "1", *place)
    spacing = re.search(r"give --spacing-mm (\d+)", ran.output)[1]
    assert "too small" in ran.output
    ran = run("--kind", "charuco", "--range-m", "6", "--pixel-mrad", "1", "--spacing-mm", spacing, *place)
    assert "large enough" in ran.output
    assert "too small" not in ran.output


@pytest.mark.parametrize("kind", ["rings", "charuco"])
def test_what_is_too_small_is_printed_by_the_options_that_are_told(tmp_path, kind):
    given = ("--kind", kind, "--range-m", "6", "--pixel-mrad", "1.9", "--output", str(tmp_path / "t.pdf"))
    ran = followed(given, re.findall(r"give (--spacing-mm \d+ --.*), or come within", run(*given).output)[0])
    assert ran.exit_code == 0
    assert "too small" not in ran.output


def test_a_paper_is_told_to_be_left_out_only_where_it_is_given(tmp_path):
    given = ("--range-m", "11", "--pixel-mrad", "1.9", "--output", str(tmp_path / "t.pdf"))
    assert " --tile A4, or come within" in run(*given).output
    assert " --tile A4 (and leave --paper out), or come within" in run("--paper", "A1", *given).output


def test_the_range_is_told_where_nothing_prints_the_target_large_enough(tmp_path):
    given = ("--range-m", "400", "--pixel-mrad", "20", "--output", str(tmp_path / "t.pdf"))
    told = run(*given).output.splitlines()[-1]
    nearer = re.fullmatch(r"  come within (\S+) m \(--range-m \1\)", told)[1]
    assert "too small" not in run(*given, "--range-m", nearer).output
    assert "too small" in run(*given, "--range-m", f"{1.01 * float(nearer):.6g}").output


def test_a_description_is_told_to_grow_and_not_by_options_that_are_refused(tmp_path):
    run("--kind", "chessboard", "--output", str(tmp_path / "a.pdf"))
    described = tmp_path / "a.yaml"
    given = ("--described", str(described), "--output", str(tmp_path / "b.pdf"))
    told = run(*given, "--range-m", "90", "--pixel-mrad", "1").output
    side = yaml.safe_load(described.read_text())["target"]["square_m"]
    assert (
        f"make all sizes in {described} {0.45 / side:.3g} times as large, or come within {90 * side / 0.45:.3g} m"
        in told
    )
    too_small = run(*given, "--paper", "A4").output
    assert "--paper" in too_small
    assert "--spacing-mm" not in too_small


def test_the_list_says_what_is_not_printed():
    rows = run("--list").output.splitlines()
    assert [row.split()[0] for row in rows if "nothing to print" in row] == ["points"]


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("--kind", "ring"), "did you mean rings"),
        (("--kind", "points"), "write `target: {kind: points}` into the platform's file"),
        (("--rows", "5"), "5 rows and 5 columns"),
        (("--paper", "A11"), "did you mean A1"),
        (("--tile", "10x10"), "--tile: found 10x10"),
        (("--spacing-mm", "0"), "--spacing-mm: found 0"),
        (("--range-m", "3"), "--pixel-mrad: found nothing"),
        (("--described", "a.yaml", "--rows", "3"), "change the file, or leave --described out"),
        (("--output", "board.png"), "give --output board.pdf"),
        (("--output", "nowhere/board.pdf"), "no folder nowhere"),
        (("--described", "missing.yaml"), "missing.yaml: found no such file"),
    ],
)
def test_faults_are_told_in_one_line(tmp_path, monkeypatch, arguments, told):
    monkeypatch.chdir(tmp_path)
    ran = run(*arguments)
    assert ran.exit_code == 1
    assert told in ran.output
    assert len(ran.output.strip().splitlines()) == 1


def test_description_is_printed_again_and_its_keys_are_explained(tmp_path):
    first, second = tmp_path / "a.pdf", tmp_path / "b.pdf"
    run("--kind", "chessboard", "--rows", "5", "--columns", "6", "--spacing-mm", "42.5", "--output", str(first))
    described = tmp_path / "a.yaml"
    assert yaml.safe_load(described.read_text())["target"]["square_m"] == 0.0425
    assert all("#" in row for row in described.read_text().splitlines()[1:])
    run("--described", str(described), "--output", str(second))
    assert first.read_bytes() == second.read_bytes()
