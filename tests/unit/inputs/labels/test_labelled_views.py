import logging

import numpy as np
import pytest

from linepose.errors import InputError
from linepose.inputs.labels.labelled_views import POINTS, read_labelled_views, select_views
from linepose.survey.point_names import WHAT

START_US = 1_466_040_439_908_160
N_PIXELS = 648


def line(point, seconds=0.0, u="100.5", north="6248551.25", roll="0.08", yaw="1.97"):
    return f"{START_US + round(seconds * 1e6)},{point},{u},{north},332962.5,-41.75,{roll},-0.01,{yaw}"


@pytest.fixture
def view(tmp_path):
    """Writes a view file and gives its path."""

    def write(*lines, name="view.csv"):
        path = tmp_path / name
        path.write_text("".join(text + "\n" for text in lines))
        return path

    return write


def message_of(*paths):
    with pytest.raises(InputError) as error:
        read_labelled_views(paths, N_PIXELS)
    assert "\n" not in str(error.value)
    return str(error.value)


def test_views_are_numbered_in_order_and_their_points_sorted(view):
    first = view(line(1, 0.1, u="7.5"), line(0, 0.0, u="2"), name="a.csv")
    second = view(line(2, 5.0), name="b.csv")
    table = read_labelled_views([first, second], N_PIXELS)
    assert list(table.columns) == POINTS.names
    assert table[["observation", "point", "u_px"]].to_numpy().tolist() == [[1, 0, 2.0], [1, 1, 7.5], [2, 2, 100.5]]
    assert table["time_us"].tolist() == [START_US, START_US + 100_000, START_US + 5_000_000]
    assert table.iloc[2, 4:].tolist() == [6248551.25, 332962.5, -41.75, 0.08, -0.01, 1.97]


def test_unlabelled_point_is_left_out_and_told_of(view, caplog):
    path = view(line(0), line(4, 1.0, u=""), line(2, 2.0, u="nan"))
    with caplog.at_level(logging.WARNING):
        table = read_labelled_views([path], N_PIXELS)
    assert table["point"].tolist() == [0]
    assert caplog.messages == [f"{path}: no label for point 4, 2: left out"]


def test_points_have_names_and_no_number_is_an_index(view):
    path = view(line("gate"), line("07", 1.0), line("1e6", 2.0))
    assert read_labelled_views([path], N_PIXELS)["point"].tolist() == ["1000000", "7", "gate"]
    assert read_labelled_views([view(line("1e6"), line("07", 1.0))], N_PIXELS)["point"].tolist() == [7, 1_000_000]


def test_unlabelled_point_may_lack_everything_else(view):
    path = view(line(0), line(1, u="", north=""))
    assert len(read_labelled_views([path], N_PIXELS)) == 1


@pytest.mark.parametrize("u", ["-0.5", "647.5"])
def test_the_outermost_pixels_edge_belongs_to_the_sensor(view, u):
    assert read_labelled_views([view(line(0, u=u))], N_PIXELS)["u_px"].tolist() == [float(u)]


@pytest.mark.parametrize(
    ("bad", "place", "fault"),
    [
        (
            line(1, u="647.6"),
            ", row 2, column 3",
            "found pixel 647.6, expected a pixel of the sensor, -0.5 to 647.5; correct the label, or camera.n_pixels",
        ),
        (
            line(1, u="-1"),
            ", row 2, column 3",
            "found pixel -1, expected a pixel of the sensor, -0.5 to 647.5; correct the label, or camera.n_pixels",
        ),
        (
            line(1, u="inf"),
            ", row 2, u_px",
            "found no number, expected a number in each cell of a labelled point; mend the cell",
        ),
        (
            line(1, roll="nan"),
            ", row 2, roll_rad",
            "found no number, expected a number in each cell of a labelled point; mend the cell",
        ),
        (
            line(1, north=""),
            ", row 2, north_m",
            "found no number, expected a number in each cell of a labelled point; mend the cell",
        ),
        (line(1, yaw="north"), ", row 2, column 9", "found 'north', expected a number; mend the cell"),
        (
            line(1, yaw="112.9"),
            ", row 2, columns 7-9",
            "found angles [0.08, -0.01, 112.9], expected radians; convert degrees to radians",
        ),
        (line(0), ", row 2, column 2", "found point 0 again, expected each point once a view; remove one of the rows"),
        (
            line(-1),
            ", row 2, column 2",
            f"found point '-1', expected {WHAT}; correct the point's id",
        ),
        (
            line(1.5),
            ", row 2, column 2",
            f"found point '1.5', expected {WHAT}; correct the point's id",
        ),
        (
            line(1).rsplit(",", 1)[0],
            ", row 2",
            "found 8 columns, expected 9 columns (time (us), point, u (px), north, east, down (m), roll, pitch, "
            "yaw (rad)); mend the row",
        ),
        (
            line(1)[:10] + line(1)[16:],
            ", row 2, column 1",
            "found time 1466040439, expected microseconds since 1970-01-01; "
            "they look like seconds: multiply by 1000000",
        ),
    ],
)
def test_names_file_row_and_remedy(view, bad, place, fault):
    path = view(line(0), bad)
    assert message_of(path) == f"{path}{place}: {fault}"


def test_repeated_point_is_named_by_its_row_in_the_file(view):
    path = view(line(3), line(9, u=""), line(4), line(3))
    assert message_of(path).startswith(f"{path}, row 4, column 2: found point 3 again")


def test_empty_file(view):
    path = view()
    assert message_of(path) == (
        f"{path}: found an empty file, expected time (us), point, u (px), north, east, down (m), roll, pitch, "
        "yaw (rad); restore it, or leave it out"
    )


def test_view_without_a_label(view):
    path = view(line(0, u=""))
    assert message_of(path) == f"{path}: found no labelled point, expected at least one; leave the file out"


def test_views_out_of_order_are_named_by_the_row_of_their_earliest_time(view):
    first = view(line(0, 0.0), line(1, 10.0), name="a.csv")
    second = view(line(0, 11.0), line(1, 9.5), name="b.csv")
    assert message_of(first, second) == (
        f"{second}, row 2, column 1: found time {START_US + 9_500_000}, expected a time after the view before it "
        f"({START_US + 10_000_000}); name the files so that their order is that of time"
    )


@pytest.mark.parametrize(("pattern", "first", "n_files"), [("*.txt", 1, 0), ("*.csv", 3, 2)])
def test_no_view_at_all(tmp_path, pattern, first, n_files):
    for name in ("a.csv", "b.csv"):
        (tmp_path / name).touch()
    with pytest.raises(InputError) as caught:
        select_views(tmp_path, pattern, first, 1)
    assert str(caught.value) == (
        f"{tmp_path / pattern}: found {n_files} files, expected one file a view; "
        "correct source.views and source.first, or put the files there"
    )


def test_selection_counts_from_one_in_the_order_of_names(tmp_path):
    for name in ("05.csv", "02.csv", "04.csv", "01.csv", "03.csv", "notes.txt"):
        (tmp_path / name).touch()
    chosen = [path.name for path in select_views(tmp_path, "*.csv", 2, 2)]
    assert chosen == ["02.csv", "04.csv"]
    assert [path.name for path in select_views(tmp_path, "*.csv", 1, 1)] == [f"0{n}.csv" for n in range(1, 6)]


@pytest.mark.field
def test_field_views_are_read_whole(field_data, ladybird):
    source = ladybird.source
    views = select_views(field_data, source.views, source.first, source.step)
    table = read_labelled_views(views, ladybird.camera.n_pixels)
    assert len(views) == 25
    assert table.groupby("observation")["point"].apply(list).tolist() == [list(range(15))] * 25
    assert np.all(np.diff(table.groupby("observation")["time_us"].min()) > 0)
