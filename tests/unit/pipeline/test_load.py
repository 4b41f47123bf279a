"""A platform's records are read before any result is touched: each kind of fault is found by the first reading."""

import shutil

import pytest

from linepose.errors import InputError
from linepose.pipeline.load import check_readable


@pytest.fixture
def views(field_data, tmp_path):
    """A copy of the field data that may be spoilt."""
    folder = tmp_path / "own"
    shutil.copytree(field_data, folder)
    return folder


def rewrite(path, change):
    """Replace the lines of a file."""
    path.write_text("\n".join(change(path.read_text().splitlines())) + "\n")


def with_time_of(first, second):
    """The second row at the first one's time."""
    return f"{first.split(',')[0]},{second.split(',', 1)[1]}"


@pytest.mark.field
def test_whole_record_is_told_in_numbers(field_data, ladybird):
    assert check_readable(ladybird, field_data) == "375 points in 25 views"


@pytest.mark.field
def test_view_and_covariances_are_both_read(views, ladybird):
    view = sorted(views.glob("labelled_points/*.csv"))[1]
    whole = view.read_text()
    rewrite(view, lambda rows: [rows[0].replace(",0,", ",-1,"), *rows[1:]])
    with pytest.raises(InputError, match=r"-split_target_points\.csv, row 1, column 2: found point '-1'"):
        check_readable(ladybird, views)
    view.write_text(whole)
    rewrite(views / "nav_covs.csv", lambda rows: [rows[0], with_time_of(rows[0], rows[1]), *rows[2:]])
    with pytest.raises(InputError, match=r"nav_covs\.csv, row 2, column 1: found time"):
        check_readable(ladybird, views)


@pytest.mark.field
def test_gap_and_too_few_views_are_found(views, ladybird):
    first = ladybird.model_copy(update={"source": ladybird.source.model_copy(update={"first": 50})})
    with pytest.raises(InputError, match=r"labelled_points/\*\.csv: found 0 spare equations"):
        check_readable(first, views)
    rewrite(views / "nav_covs.csv", lambda rows: rows[:2])
    with pytest.raises(InputError, match=r"at most 1 s; complete the navigation log"):
        check_readable(ladybird, views)
