"""Spoilt files of every kind give a result that holds, or one line of ours that names the file."""

import pytest
from hypothesis import HealthCheck, given, settings

from unit.bad_input.mutations import mutated, mutations
from unit.bad_input.outcome import FAULTS, READ, outcome
from unit.bad_input.readers import readers, registered

EXAMPLES = 3


@pytest.mark.parametrize("name", readers())
def test_whole_and_spoilt_files_are_read_or_refused_in_one_line(name):
    reader = readers()[name]
    if reader.package:
        pytest.importorskip(reader.package)
    whole = outcome(reader, reader.whole())
    assert whole.kind == READ, whole.told

    @settings(
        max_examples=EXAMPLES,
        derandomize=True,
        database=None,
        deadline=None,
        suppress_health_check=list(HealthCheck),
    )
    @given(mutations(reader.is_text))
    def holds(done):
        found = outcome(reader, mutated(reader.whole(), done))
        assert found.kind not in FAULTS, found.told

    holds()


def test_every_registered_reader_is_in_the_set():
    assert registered() - {of for reader in readers().values() for of in reader.of} == set()


def test_the_set_names_no_reader_that_is_not_registered():
    assert {of for reader in readers().values() for of in reader.of} - registered() == set()
