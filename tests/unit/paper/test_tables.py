"""Tables 2-5: each printed number beside the one obtained for it."""

import numpy as np
import pandas as pd
import pytest

from linepose.geometry.pose import POSE_COLUMNS, SIGMA_COLUMNS
from linepose.paper.hand_measured import hand_measured_sigma
from linepose.paper.tables import PUBLISHED_NAVIGATION, PUBLISHED_POSES, markdown, published_tables
from linepose.survey.navigation import SIGMA_COLUMNS as NAVIGATION_SIGMA_COLUMNS
from linepose.tables import read_table, write_table
from unit.paper.reproduced import DECLARED, PUBLISHED


def as_printed(entries: dict, names: dict, column: str, shift: float) -> pd.DataFrame:
    """Results that lie `shift` published sigmas above the printed poses."""
    rows = []
    for printed, own in names.items():
        pose, sigma = np.array(entries[printed]["pose"]), np.array(entries[printed]["sigma"])
        values = dict(zip(POSE_COLUMNS, pose + shift * sigma, strict=True)) | dict(
            zip(SIGMA_COLUMNS, 2 * sigma, strict=True)
        )
        rows.append({column: own, **values})
    return pd.DataFrame(rows)


@pytest.fixture
def tables():
    navigation = pd.DataFrame([PUBLISHED["table2"]["ladybird"]], columns=list(NAVIGATION_SIGMA_COLUMNS))
    navigation.iloc[0, 3:] = np.deg2rad(navigation.iloc[0, 3:].to_numpy(dtype=float))
    stages = {"all_25": "all", "inliers_16": "inliers", "hand_measured": "hand_measured"}
    return published_tables(
        "ladybird",
        PUBLISHED,
        1.02 * navigation,
        as_printed(PUBLISHED["table3"]["ladybird"], stages, "stage", 0.25),
        as_printed(PUBLISHED["table4"], {"high": "high", "low": "low"}, "subset", -0.5),
        as_printed(PUBLISHED["table5"], {"subset_2": "subset_2", "subset_1": "subset_1"}, "subset", 1.0),
        DECLARED,
    )


def test_differences_are_in_published_sigmas(tables):
    for name, shift, n_sets in (("table3", 0.25, 3), ("table4", -0.5, 2), ("table5", 1.0, 2)):
        assert len(tables[name]) == 6 * n_sets
        np.testing.assert_allclose(tables[name]["difference_sigmas"], shift, rtol=1e-9)
        table = tables[name][tables[name]["set"] != "hand_measured"]
        np.testing.assert_allclose(table["obtained_sigma"], 2 * table["published_sigma"])


def test_hand_measured_sigmas_are_those_of_the_papers_rule(tables):
    table = tables["table3"].set_index("set").loc["hand_measured"]
    np.testing.assert_allclose(
        table["obtained_sigma"], hand_measured_sigma(table["obtained"].to_numpy(copy=True)), rtol=1e-12
    )


def test_navigation_table_is_in_degrees_and_relative(tables):
    table = tables["table2"].set_index("quantity")
    np.testing.assert_allclose(table["relative_difference"], 0.02, rtol=1e-9)
    assert table["published"].iloc[3] == 2.362e-1
    assert table.index[3].endswith("_deg")


def test_known_deviation_carries_its_reason(tables):
    notes = tables["table4"].groupby("set")["note"].first()
    assert "21.163" in notes["low"]
    assert notes["high"] == ""


def test_tables_fit_their_schemas(tables, tmp_path):
    for name, table in tables.items():
        schema = PUBLISHED_NAVIGATION if name == "table2" else PUBLISHED_POSES
        write_table(table, tmp_path / name, schema)
        assert read_table(tmp_path / name, schema).equals(table[schema.names])


def test_markdown_has_a_row_for_each(tables):
    lines = markdown(tables["table5"], "Table 5").splitlines()
    assert lines[0] == "# Table 5"
    assert lines[2].startswith("| platform | set | parameter |")
    assert len(lines) == 2 + 2 + 12
    assert "| ladybird | subset_1 | r_x_m | 0.192 | 0.238 | 1 |" in lines[4]
