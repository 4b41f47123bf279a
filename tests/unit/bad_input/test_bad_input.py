"""Spoilt files of every kind give a result that holds, or one line of ours that names the file."""

import time

import pytest
from hypothesis import HealthCheck, given, settings

from linepose.errors import LineposeError
from unit.bad_input.mutations import mutated, mutations
from unit.bad_input.readers import READERS, readers

EXAMPLES = 4
LONGEST_S = 10
LONGEST_LINE = 2_500


def spoilt(reader, done, folder):
    """The fault's line, or what was read."""
    for name, whole in reader.files.items():
        (folder / name).write_bytes(mutated(whole, done) if name == reader.spoilt else whole)
    try:
        return reader.read(folder), None
    except LineposeError as error:
        return None, str(error)


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", READERS)
def test_whole_files_are_read(name, tmp_path):
    reader = readers()[name]
    value, told = spoilt(reader, (), tmp_path)
    assert told is None
    assert reader.holds(value)


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", READERS)
def test_spoilt_files_are_read_or_refused_in_one_line(name, tmp_path):
    reader = readers()[name]
    spoilt(reader, (), tmp_path)  # what the first reading imports is not timed

    @settings(
        max_examples=EXAMPLES,
        derandomize=True,
        database=None,
        deadline=None,
        suppress_health_check=list(HealthCheck),
    )
    @given(mutations(reader.is_text))
    def holds(done):
        begun = time.process_time()
        value, told = spoilt(reader, done, tmp_path)
        assert time.process_time() - begun < LONGEST_S
        if told is None:
            assert reader.holds(value)
        else:
            assert told.isprintable()
            assert len(told) < LONGEST_LINE
            assert str(tmp_path) in told or "config" in told

    holds()


def test_the_readers_are_those_of_the_list():
    assert tuple(readers()) == READERS
