import pytest

from linepose.cli.labelling.session import resumed, save, table_of
from linepose.survey.pattern import N_POINTS


@pytest.fixture
def session():
    return resumed([2, 5, 7], {}, range(N_POINTS))


def test_points_are_placed_in_their_order(session):
    session.place(1.00049, 2.0)
    session.skip()
    session.place(3.0, 4.0)
    assert session.labels == {(2, 0): (1.0, 2.0), (2, 2): (3.0, 4.0)}
    assert session.point == 3


def test_undo_takes_each_step_back(session):
    session.place(1.0, 2.0)
    session.skip()
    session.turn(1)
    session.place(5.0, 6.0)
    session.undo()
    assert (session.observation, session.point, session.labels) == (5, 0, {(2, 0): (1.0, 2.0)})
    session.undo()
    assert (session.observation, session.point) == (2, 1)
    session.undo()
    assert (session.observation, session.point, session.labels) == (2, 0, {})
    session.undo()
    assert session.labels == {}


def test_undo_brings_a_label_back_that_was_replaced_or_skipped(session):
    session.place(1.0, 2.0)
    session.point = 0
    session.place(9.0, 9.0)
    session.undo()
    session.skip()
    assert session.labels == {}
    session.undo()
    assert session.labels == {(2, 0): (1.0, 2.0)}


def test_a_scan_that_is_done_takes_no_more(session):
    for point in range(N_POINTS):
        session.place(float(point), 0.0)
    session.place(99.0, 0.0)
    session.skip()
    assert len(session.labels) == N_POINTS
    assert session.point == N_POINTS
    session.undo()
    assert session.point == N_POINTS - 1


def test_turning_stays_within_the_scans(session):
    session.turn(-1)
    assert session.observation == 2
    session.turn(5)
    assert session.observation == 7


def test_session_goes_on_where_it_was_left():
    labels = {(2, point): (1.0, 1.0) for point in range(N_POINTS)} | {(5, point): (1.0, 1.0) for point in range(4)}
    session = resumed([2, 5, 7], labels, range(N_POINTS))
    assert (session.observation, session.point) == (5, 4)
    session.undo()  # nothing was done in this session: the last label of the earlier one
    assert session.point == 3
    assert (5, 3) not in session.labels
    assert resumed([2], labels, range(N_POINTS)).point == N_POINTS


def test_points_by_name_are_new_as_they_are_placed_and_known_afterwards(tmp_path):
    session = resumed([2, 5], {}, (), takes_new=True)
    session.place(1.0, 1.0)
    assert session.choose("gate")
    session.place(2.0, 2.0)
    assert not session.choose("-1")
    session.turn(1)
    assert (session.names, session.name) == ([0, "gate"], 0)
    session.skip()
    session.place(3.0, 3.0)
    session.choose_new()
    session.place(4.0, 4.0)
    assert session.labels == {(2, 0): (1, 1), (2, "gate"): (2, 2), (5, "gate"): (3, 3), (5, 1): (4, 4)}
    session.undo()
    assert (session.name, (5, 1) in session.labels) == (1, False)
    save(session, tmp_path / "labels.csv")
    assert (tmp_path / "labels.csv").read_text().split()[1:] == ["2,0,1,1", "2,gate,2,2", "5,gate,3,3"]
    again = resumed([2, 5, 7], session.labels, (), takes_new=True)
    assert (again.observation, again.names, again.name) == (7, [0, "gate"], 0)


def test_labels_are_saved_in_order(session, tmp_path):
    session.labels = {(5, 3): (1.25, 2.0), (2, 4): (3.0, 4.5)}
    save(session, tmp_path / "labels.csv")
    assert (tmp_path / "labels.csv").read_text() == "observation,point,u_px,line\n2,4,3,4.5\n5,3,1.25,2\n"
    assert list(table_of({}).columns) == ["observation", "point", "u_px", "line"]
