import shutil
from pathlib import Path

import pytest

from linepose.output.figures.entry import FIGURES
from linepose.output.report.assemble import platform_on_page
from linepose.output.report.page import render_platform_page
from linepose.output.report.provenance import settings_text, versions
from linepose.pipeline.calibration import Calibration
from linepose.tables import write_table
from unit import made_up


@pytest.fixture(scope="session")
def results(tmp_path_factory):
    folder = tmp_path_factory.mktemp("results") / "made-up"
    made_up.write_results(folder)
    return Calibration.from_results(folder, made_up.platform(description="Fast & <made up>"))


@pytest.fixture(scope="session")
def page(results, drawn):
    """The whole report of one made-up platform."""
    figures, index = drawn
    folder = Path(
        shutil.copytree(figures / "figures", results.results.path("figures/index").parent, dirs_exist_ok=True)
    )
    write_table(index, folder / "index.parquet", FIGURES)
    one = platform_on_page(results, results.platform.model_dump(mode="json"))
    study = settings_text({"data_folders": ["data", "/home/someone/private/data"], "seed": 1})
    return render_platform_page(one, study, versions())
