"""A platform's records are read before any result is touched: each kind of fault is found by the first reading."""

import pytest

from linepose.errors import InputError
from linepose.pipeline.load import check_readable
from unit.planted_faults import FAULTS, planted, told_of


@pytest.mark.field
def test_whole_record_is_told_in_numbers(field_data, ladybird):
    assert check_readable(ladybird, field_data) == "375 measurements of 15 points in 25 views"


@pytest.mark.field
@pytest.mark.parametrize("name", FAULTS)
def test_each_fault_is_found_by_the_first_reading(name, field_data, ladybird, tmp_path):
    keys = planted(name, field_data, tmp_path / "own")
    source = ladybird.source.model_copy(update=keys)
    with pytest.raises(InputError) as fault:
        check_readable(ladybird.model_copy(update={"source": source}), tmp_path / "own")
    assert told_of(name) in str(fault.value)
    assert len(str(fault.value).splitlines()) == 1
