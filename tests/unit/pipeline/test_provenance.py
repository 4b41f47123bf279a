"""What results say of what made them."""

import json

import pandas as pd
import pyarrow as pa
import pytest

from linepose import tables
from linepose.pipeline.provenance import content_digest, plain_settings, provenance_of_job, read_provenance
from linepose.tables import mark_tables, write_table

SCHEMA = pa.schema([pa.field("value", pa.float64(), nullable=False)])
TABLE = pd.DataFrame({"value": [1.0]})


@pytest.fixture(autouse=True)
def unmarked(monkeypatch):
    monkeypatch.setattr(tables, "_marks", {})


def test_result_says_what_made_it(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "results").mkdir()
    (tmp_path / "results" / "input.csv").write_text("1")
    (tmp_path / "elsewhere.csv").write_text("2")
    parameters = {"platform": {"focal": 8.2e-3}, "seed": 3, "code": "optimise abc", "folder": str(tmp_path)}
    made = provenance_of_job(parameters, ["results/input.csv", tmp_path / "elsewhere.csv"])
    mark_tables(made.text())
    write_table(TABLE, "result.parquet", SCHEMA)
    found = read_provenance("result.parquet")
    assert found == made
    assert found.settings == {"platform": {"focal": 8.2e-3}, "seed": 3}
    assert found.code == "optimise abc"
    assert found.inputs == {
        "results/input.csv": content_digest(tmp_path / "results" / "input.csv"),
        "elsewhere.csv": content_digest(tmp_path / "elsewhere.csv"),
    }
    assert str(tmp_path) not in made.text()


def test_text_is_the_same_for_the_same_values():
    one = provenance_of_job({"a": {"x": 1, "y": (2, 3)}, "b": None}, [])
    assert one.text() == provenance_of_job({"b": None, "a": {"y": [2, 3], "x": 1}}, []).text()
    assert json.loads(one.text())["settings"] == {"a": {"x": 1, "y": [2, 3]}, "b": None}


def test_how_work_is_shared_out_is_no_setting():
    assert plain_settings({"basin": {"batch_size": 3, "n": 2}, "work": "results/work"}) == {"basin": {"n": 2}}


def test_file_without_a_mark_says_nothing(tmp_path):
    write_table(TABLE, tmp_path / "unmarked.parquet", SCHEMA)
    (tmp_path / "text.parquet").write_text("no Parquet file")
    TABLE.to_parquet(tmp_path / "others.parquet")
    for name in ("unmarked", "text", "others", "missing"):
        assert read_provenance(tmp_path / f"{name}.parquet") is None


def test_mark_changes_no_column(tmp_path):
    write_table(TABLE, tmp_path / "unmarked.parquet", SCHEMA)
    mark_tables("{}")
    write_table(TABLE, tmp_path / "marked.parquet", SCHEMA)
    pd.testing.assert_frame_equal(tables.read_table(tmp_path / "marked.parquet", SCHEMA), TABLE)
    assert (tmp_path / "marked.parquet").read_bytes() != (tmp_path / "unmarked.parquet").read_bytes()


def test_digest_of_a_folder_follows_names_and_contents(tmp_path):
    (tmp_path / "a").mkdir()
    (tmp_path / "a" / "one").write_text("1")
    before = content_digest(tmp_path / "a")
    assert content_digest(tmp_path / "a") == before
    (tmp_path / "a" / "one").write_text("2")
    changed = content_digest(tmp_path / "a")
    (tmp_path / "a" / "one").rename(tmp_path / "a" / "two")
    assert len({before, changed, content_digest(tmp_path / "a")}) == 3
