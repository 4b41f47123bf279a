"""All figures of a platform on disk: which are drawn, what stands in the place of the others, the same bytes again."""

import hashlib
import os
import shutil
import subprocess
import sys
from contextlib import suppress
from functools import cache
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from matplotlib.text import Text
from PIL import Image

from linepose.errors import LineposeError
from linepose.output.figures.registry import FIGURES
from linepose.output.figures.render import render_figures
from linepose.output.figures.style import HALF_PAGE_IN, LEAST_PT, PNG_DPI, blank_figure, save
from linepose.output.report.platform_sections import platform_sections
from linepose.pipeline.calibration import Calibration
from linepose.pipeline.summary import summarise
from linepose.pipeline.table_checks import usable_chain
from unit import made_up

NOT_MADE = {entry.name for entry in FIGURES if entry.left_out(made_up.platform())}  # for want of scans or experiments


def test_every_figure_is_drawn_or_has_a_sentence_in_its_place(drawn):
    folder, index = drawn
    assert {"stacked_scan", "labelled_points"} < NOT_MADE
    assert list(index["figure"]) == [entry.name for entry in FIGURES]
    assert set(index.loc[index["left_out"] != "", "figure"]) == NOT_MADE
    files = {path.name for path in (folder / "figures").iterdir()}
    shown = set(index["figure"]) - NOT_MADE
    assert files == {f"{name}.{kind}" for name in shown for kind in ("png", "pdf")}
    assert all(index.loc[index["left_out"] == "", "caption"].str.endswith("."))


def test_nothing_is_cut_off_at_an_edge(drawn):
    for path in sorted((drawn[0] / "figures").glob("*.png")):
        with Image.open(path) as image:
            light = np.asarray(image.convert("L"))
        for edge in (light[0], light[-1], light[:, 0], light[:, -1]):
            assert edge.min() > 250, path.name


def test_a_broken_chain_costs_its_figures_and_no_other(drawn, tmp_path):
    made_up.write_results(tmp_path)
    chain = made_up.samples()
    chain.loc[7, "theta_x_rad"] = float("nan")
    chain.to_parquet(tmp_path / "mcmc" / "inliers.parquet")
    lost = {"corner", "rotation_axis", "platform_sketch", "trace", "autocorrelation"}
    entries = [entry for entry in FIGURES if entry.name in lost | {"outliers", "mapping"}]
    index = render_figures(Calibration.from_results(tmp_path, made_up.platform()), tmp_path / "figures", entries)
    left_out = index.set_index("figure")["left_out"]
    assert {entry.name for entry in FIGURES if "mcmc/inliers" in entry.needs} == lost
    assert set(left_out[left_out != ""].index) == lost
    assert "theta_x_rad" in left_out["corner"]
    assert not any((tmp_path / "figures" / f"{name}.png").exists() for name in lost)


def test_what_was_not_asked_for_is_said_and_what_is_missing_is_named(tmp_path):
    made_up.write_results(tmp_path)
    (tmp_path / "uncertainty.parquet").unlink()
    platform = made_up.platform(outline=None, experiments={"basin": None, "mapping": None, "repeatability": None})
    words = {
        "basin": "experiments.basin",
        "mapping": "experiments.mapping",
        "angle_error": "experiments.mapping",
        "repeatability": "splits",
        "platform_sketch": "outline",
        "stacked_scan": "no scans",
        "uncertainty": "no such result",
    }
    entries = [entry for entry in FIGURES if entry.name in words]
    index = render_figures(Calibration.from_results(tmp_path, platform), tmp_path / "figures", entries)
    left_out = index.set_index("figure")["left_out"]
    for name, word in words.items():
        assert word in left_out[name]


def reads(reader, folder):
    """What a figure, a caption or a part of the page reads."""
    results = Calibration.from_results(folder, made_up.platform())
    reader(results)
    return set(results.results._read)


@pytest.fixture(scope="module")
def figure_of(drawn):
    """The figure of an entry, drawn once, and what it reads."""

    @cache
    def draw(entry):
        results = Calibration.from_results(drawn[0], made_up.platform())
        return entry.draw(results), set(results.results._read)

    return draw


@pytest.mark.parametrize("entry", [entry for entry in FIGURES if entry.name not in NOT_MADE], ids=lambda e: e.name)
def test_an_entry_names_the_results_that_its_figure_is_drawn_from(drawn, figure_of, entry):
    assert figure_of(entry)[1] | reads(entry.caption, drawn[0]) <= set(entry.needs)


@pytest.fixture(scope="module")
def readers(drawn, figure_of):
    """Everything that is made from results, with the tables that each reads."""
    entries = [entry for entry in FIGURES if entry.name not in NOT_MADE]
    makers = [*(entry.caption for entry in entries), summarise, platform_sections]
    of_figures = [(entry.draw, figure_of(entry)[1]) for entry in entries]
    return [(maker, reads(maker, drawn[0])) for maker in makers] + of_figures


@pytest.mark.parametrize("name", made_up.TABLES)
def test_a_result_of_which_one_row_is_left_is_told_by_an_error_of_ours_or_still_makes_sense(
    drawn, readers, tmp_path, name
):
    folder = shutil.copytree(drawn[0], tmp_path / "made_up")
    path = folder / f"{name}.parquet"
    pd.read_parquet(path).iloc[-1:].to_parquet(path)
    for maker, tables in readers:
        if name in tables:
            with suppress(LineposeError):
                made = maker(Calibration.from_results(folder, made_up.platform()))
                assert not isinstance(made, str) or "nan" not in made


@pytest.mark.parametrize(
    ("spoil", "told"),
    [
        (lambda table: table.iloc[:0], "no rows"),
        (lambda table: table.drop(columns="error_px"), "no column error_px"),
        (lambda table: table.assign(error_px=float("nan")), "24 of 24 numbers of error_px not finite"),
        (lambda table: table[table["stage"] != "inliers"], "no rows"),
    ],
)
def test_a_spoilt_result_is_named_with_what_is_wrong(tmp_path, spoil, told):
    made_up.write_results(tmp_path)
    table = pd.concat([made_up.residuals(), made_up.residuals().iloc[:8].assign(stage="all")])
    spoil(table).to_parquet(tmp_path / "residuals.parquet")
    with pytest.raises(LineposeError, match=told):
        summarise(Calibration.from_results(tmp_path, made_up.platform()))


def test_a_chain_that_stands_still_is_told_rather_than_drawn():
    with pytest.raises(LineposeError, match="the same value of r_x_m in all 320 rows"):
        usable_chain(made_up.samples().assign(r_x_m=0.19))


@pytest.mark.parametrize("entry", [entry for entry in FIGURES if entry.name not in NOT_MADE], ids=lambda e: e.name)
def test_text_can_be_read_where_the_figure_is_printed_at_half_a_page(figure_of, entry):
    figure, _ = figure_of(entry)
    figure.draw_without_rendering()
    shrunk = min(1.0, HALF_PAGE_IN / figure.get_figwidth())
    texts = [text for text in figure.findobj(Text) if text.get_visible() and text.get_text()]
    assert texts
    assert min(text.get_fontsize() for text in texts) * shrunk >= LEAST_PT


def test_pictures_have_the_stated_size(drawn):
    folder, _ = drawn
    with Image.open(folder / "figures" / "mapping.png") as image:
        assert image.width == HALF_PAGE_IN * PNG_DPI
        assert "Software" not in image.info


_REDRAW = """
import sys
from pathlib import Path
from linepose.output.figures.registry import FIGURES
from linepose.output.figures.render import render_figures
from linepose.pipeline.calibration import Calibration
sys.path.insert(0, sys.argv[1])
from unit import made_up
folder = Path(sys.argv[2])
some = [entry for entry in FIGURES if entry.name in sys.argv[4:]]
render_figures(Calibration.from_results(folder, made_up.platform()), Path(sys.argv[3]), some)
"""
REDRAWN = ["corner", "basin", "mapping", "weights", "levels", "survey_plan", "platform_sketch"]  # one of each kind


def test_another_process_draws_the_same_bytes(drawn, tmp_path):
    folder, _ = drawn
    environment = os.environ | {"PYTHONHASHSEED": "77", "OMP_NUM_THREADS": "1", "SOURCE_DATE_EPOCH": "1"}
    tests = Path(__file__).parents[3]
    subprocess.run([sys.executable, "-c", _REDRAW, tests, folder, tmp_path, *REDRAWN], check=True, env=environment)
    redrawn, before = digests(tmp_path), digests(folder / "figures")
    assert redrawn == {name: before[name] for name in redrawn}
    assert {Path(name).stem for name in redrawn} == set(REDRAWN) - NOT_MADE


def digests(folder):
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in sorted(folder.iterdir())}


def test_a_figure_that_cannot_be_written_leaves_nothing(tmp_path):
    figure = blank_figure(1.0, 1.0)
    figure.add_subplot().set_xlabel("$broken")
    figure.axes[0].set_ylabel(r"$\nosuchcommand$")
    with pytest.raises(ValueError, match="nosuchcommand"):
        save(figure, tmp_path / "broken")
    assert list(tmp_path.iterdir()) == []
