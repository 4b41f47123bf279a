"""The made-up platform's figures, which take longer than all else of the output: drawn once for all test processes."""

from pathlib import Path

import pandas as pd
import pytest
from made_once import made_once

from linepose.output.figures.entry import FIGURES
from linepose.output.figures.render import render_figures
from linepose.pipeline.calibration import Calibration
from linepose.tables import read_table, write_table
from unit import made_up


def _draw(folder: Path) -> None:
    made_up.write_results(folder / "made-up")
    results = Calibration.from_results(folder / "made-up", made_up.platform())
    write_table(render_figures(results, folder / "made-up" / "figures"), folder / "made-up" / "index.parquet", FIGURES)


@pytest.fixture(scope="session")
def drawn(tmp_path_factory) -> tuple[Path, pd.DataFrame]:
    """The made-up results with all figures, and the figures' index; tests must not change them."""
    folder = made_once(tmp_path_factory, "drawn", _draw) / "made-up"
    return folder, read_table(folder / "index.parquet", FIGURES)
