import errno
import os
import stat

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from linepose.errors import InputError
from linepose.tables import atomic_write, floats, point_column, read_table, write_csv, write_table

SCHEMA = pa.schema([pa.field("point", pa.int64(), nullable=False), pa.field("u_px", pa.float64(), nullable=False)])
TABLE = pd.DataFrame({"u_px": [0.1, np.inf, -3.0], "point": [0, 1, 2]})
OLD = b"an earlier result"


@pytest.fixture
def earlier(tmp_path):
    """A result of an earlier run, which a failure must leave as it is."""
    path = tmp_path / "table.parquet"
    path.write_bytes(OLD)
    return path


def names_in(folder):
    return [path.name for path in folder.iterdir()]


def assert_untouched(path):
    assert path.read_bytes() == OLD
    assert names_in(path.parent) == [path.name]


def test_names_of_points_are_numbers_or_text_by_the_table(tmp_path):
    schema, path = pa.schema([point_column()]), tmp_path / "table.parquet"
    for names in ([3, 10**12], ["gate", "7"]):
        write_table(pd.DataFrame({"point": names}), path, schema)
        assert read_table(path, schema)["point"].tolist() == names
    plain = tmp_path / "plain.parquet"
    write_table(pd.DataFrame({"point": [3]}), path, schema)
    write_table(pd.DataFrame({"point": [3]}), plain, pa.schema([pa.field("point", pa.int64(), nullable=False)]))
    assert path.read_bytes() == plain.read_bytes()


def test_table_returns_in_the_schemas_order(tmp_path):
    path = tmp_path / "new" / "folder" / "table.parquet"
    write_table(TABLE, path, SCHEMA)
    back = read_table(path, SCHEMA)
    assert list(back.columns) == ["point", "u_px"]
    pd.testing.assert_frame_equal(back, TABLE[["point", "u_px"]])


def test_file_has_the_schema_and_nothing_of_who_wrote_it(tmp_path):
    write_table(TABLE, tmp_path / "t.parquet", SCHEMA)
    assert pq.read_schema(tmp_path / "t.parquet").equals(SCHEMA, check_metadata=True)


def test_same_values_give_the_same_bytes(tmp_path):
    first, second = tmp_path / "a.parquet", tmp_path / "b.parquet"
    write_table(TABLE, first, SCHEMA)
    write_table(TABLE.rename(index=lambda i: i + 7)[["point", "u_px"]], second, SCHEMA)
    assert first.read_bytes() == second.read_bytes()
    write_table(TABLE, first, SCHEMA)
    assert first.read_bytes() == second.read_bytes()


def test_everybody_may_read_a_result(tmp_path):
    write_table(TABLE, tmp_path / "t.parquet", SCHEMA)
    assert stat.S_IMODE((tmp_path / "t.parquet").stat().st_mode) == 0o644


@pytest.mark.parametrize(
    ("table", "found"),
    [
        (TABLE[["point"]], "name 'u_px' present in the specified schema is not found in the columns or index"),
        (TABLE.assign(u_m=0.0), "columns ['u_m']"),
        (TABLE.assign(point=[0.0, 1.5, 2.0]), "Float value 1.500000 was truncated converting to int64"),
        (TABLE.assign(u_px=["left", "left", "left"]), "Failed to parse string: 'left' as a scalar of type double"),
        (TABLE.assign(u_px=[0.1, np.nan, 0.2]), "Field pyarrow.Field<u_px: double not null> was non-nullable"),
    ],
)
def test_table_that_does_not_fit_is_refused_in_one_line(earlier, table, found):
    with pytest.raises(InputError) as error:
        write_table(table, earlier, SCHEMA)
    message = str(error.value)
    assert message.startswith(f"{earlier}: found {found}")
    assert message.split(", expected ")[1].startswith("columns ['point', 'u_px']")
    assert message.endswith("; mend the result")
    assert "\n" not in message
    assert_untouched(earlier)


@pytest.mark.parametrize("fault", [OSError("disk full"), KeyboardInterrupt()])
def test_interruption_in_the_middle_leaves_the_earlier_result(earlier, monkeypatch, fault):
    def half(table, path, **_):
        path.write_bytes(b"PAR1 half of")
        raise fault

    monkeypatch.setattr("linepose.tables.pq.write_table", half)
    with pytest.raises(type(fault)):
        write_table(TABLE, earlier, SCHEMA)
    assert_untouched(earlier)


def test_interrupted_first_result_leaves_nothing(tmp_path):
    def interrupted():
        with atomic_write(tmp_path / "new.txt") as temporary:
            temporary.write_text("half")
            raise RuntimeError

    with pytest.raises(RuntimeError):
        interrupted()
    assert names_in(tmp_path) == []


def test_until_the_block_ends_the_earlier_result_stands(earlier):
    with atomic_write(earlier) as temporary:
        temporary.write_bytes(b"new")
        assert earlier.read_bytes() == OLD
        assert temporary.suffix == earlier.suffix
    assert earlier.read_bytes() == b"new"
    assert names_in(earlier.parent) == [earlier.name]


def test_missing_table(tmp_path):
    path = tmp_path / "none.parquet"
    with pytest.raises(InputError) as error:
        read_table(path, SCHEMA)
    assert (
        str(error.value) == f"{path}: found no such file, expected a result of an earlier stage; run that stage first"
    )


@pytest.mark.parametrize("content", [b"", OLD, b"PAR1"])
def test_file_that_is_no_parquet(earlier, content):
    earlier.write_bytes(content)
    with pytest.raises(InputError) as error:
        read_table(earlier, SCHEMA)
    assert str(error.value).startswith(f"{earlier}: found ")
    assert str(error.value).endswith(", expected a Parquet file; delete it and run again")
    assert "\n" not in str(error.value)


def test_truncated_table(tmp_path):
    path = tmp_path / "t.parquet"
    write_table(TABLE, path, SCHEMA)
    path.write_bytes(path.read_bytes()[:-20])
    with pytest.raises(InputError) as error:
        read_table(path)
    assert str(error.value).endswith(", expected a Parquet file; delete it and run again")


def test_table_of_another_stage(tmp_path):
    path = tmp_path / "t.parquet"
    write_table(TABLE[["point"]], path, pa.schema([SCHEMA.field("point")]))
    with pytest.raises(InputError) as error:
        read_table(path, SCHEMA)
    assert str(error.value) == f"{path}: found no column u_px, expected the stage's schema; delete it and run again"


def test_csv_has_ten_digits_and_the_same_bytes_everywhere(tmp_path):
    write_csv(pd.DataFrame({"name": ["a, b"], "value": [np.pi * 1e6]}, index=[5]), tmp_path / "t.csv")
    assert (tmp_path / "t.csv").read_bytes() == b'name,value\n"a, b",3141592.654\n'


def test_a_flipped_byte_never_gives_another_table(tmp_path):
    """Every byte of the pages is under a check sum; the rest does not change the numbers."""
    schema = pa.schema(floats("x"))
    write_table(pd.DataFrame({"x": np.arange(40.0) ** 1.5}), tmp_path / "t.parquet", schema)
    whole, data = read_table(tmp_path / "t.parquet", schema), (tmp_path / "t.parquet").read_bytes()
    refused = 0
    for place in range(0, len(data), 11):
        (tmp_path / "u.parquet").write_bytes(data[:place] + bytes([data[place] ^ 4]) + data[place + 1 :])
        try:
            assert read_table(tmp_path / "u.parquet", schema).equals(whole), place
        except InputError:
            refused += 1
    assert refused > 15


def test_a_link_stays_and_what_it_leads_to_is_written(tmp_path):
    (tmp_path / "there").mkdir()
    (tmp_path / "link").symlink_to(tmp_path / "there" / "file.csv")
    with atomic_write(tmp_path / "link") as path:
        path.write_text("new")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "there" / "file.csv").read_text() == "new"


def test_a_device_is_never_replaced(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(InputError, match="a device or pipe"), atomic_write(tmp_path / "pipe"):
        pass
    with pytest.raises(InputError, match="a folder"), atomic_write(tmp_path):
        pass


def test_a_full_disk_is_one_line_and_leaves_nothing(tmp_path):
    told = "no space left on device while it was written"
    with pytest.raises(InputError, match=told), atomic_write(tmp_path / "a.csv"):
        raise OSError(errno.ENOSPC, "No space left on device")
    assert list(tmp_path.iterdir()) == []
