"""The experiments' published numbers: what passes, what fails, what is known to deviate."""

from pathlib import Path

import pandas as pd
import pytest

from linepose.config.platform import read_yaml
from linepose.errors import EstimationError
from linepose.geometry.pose import POSE_COLUMNS, SIGMA_COLUMNS
from linepose.paper.experiments_regression import basin_rows, table_rows
from linepose.paper.regression import check_passed

PUBLISHED = read_yaml(Path(__file__).parents[3] / "config" / "paper" / "published.yaml")
LOW = PUBLISHED["table4_low_verified"]


def results(entries: dict, **poses: list[float]) -> pd.DataFrame:
    rows = []
    for name, entry in entries.items():
        pose = dict(zip(POSE_COLUMNS, poses.get(name, entry["pose"]), strict=True))
        rows.append(
            {
                "subset": name,
                **pose,
                **dict(zip(SIGMA_COLUMNS, entry["sigma"], strict=True)),
                "neg_log_likelihood": 21.163,
            }
        )
    return pd.DataFrame(rows)


@pytest.fixture
def subsets():
    return results(PUBLISHED["table4"], low=LOW["pose"])


@pytest.fixture
def pairs():
    return results(PUBLISHED["table5"])


def failed(rows: list[dict]) -> list[str]:
    return [row["quantity"] for row in rows if not row["passed"] and not row["known_deviation"]]


def test_every_number_of_tables_4_and_5_has_a_row(subsets, pairs):
    rows = table_rows("ladybird", PUBLISHED, subsets, pairs)
    assert len([row for row in rows if "Table 4" in row["quantity"]]) == 24
    assert len([row for row in rows if "Table 5" in row["quantity"]]) == 24
    assert failed(rows) == []


def test_low_diversity_deviates_with_a_reason_and_nothing_else_does(subsets, pairs):
    deviating = [row for row in table_rows("ladybird", PUBLISHED, subsets, pairs) if row["known_deviation"]]
    assert {row["quantity"].rsplit(", ", 1)[0] for row in deviating} == {"ladybird, Table 4, low"}
    assert not any(row["passed"] for row in deviating)
    assert all("21.163" in row["note"] for row in deviating)


def test_low_diversity_elsewhere_than_its_true_minimum_fails(subsets, pairs):
    subsets.loc[subsets["subset"] == "low", "r_z_m"] = -0.30
    assert failed(table_rows("ladybird", PUBLISHED, subsets, pairs)) == ["ladybird, verified, low, r_z_m"]


@pytest.mark.parametrize(("share", "n_failed"), [(1.14, 0), (1.30, 6)])
def test_sigmas_may_differ_by_15_percent(subsets, pairs, share, n_failed):
    pairs.loc[0, list(SIGMA_COLUMNS)] *= share
    assert len(failed(table_rows("ladybird", PUBLISHED, subsets, pairs))) == n_failed


@pytest.mark.parametrize(
    ("inside", "outside", "n_failed"),
    [(1.0, 0.5, 0), (36 / 37, 0.75, 0), (35 / 37, 0.6, 1), (1.0, 0.49, 1), (0.9, 0.76, 2)],
)
def test_basin_claims(inside, outside, n_failed):
    summary = pd.DataFrame(
        {
            "optimiser": ["powell", "powell", "wide", "wide"],
            "region": ["inside", "outside", "inside", "outside"],
            "success_rate": [inside, outside, 0.0, 0.0],
        }
    )
    rows = basin_rows("ladybird", PUBLISHED, summary)
    assert len(rows) == 2
    assert len(failed(rows)) == n_failed
    if n_failed:
        with pytest.raises(EstimationError, match=r"section 4\.7"):
            check_passed(pd.DataFrame(rows))
