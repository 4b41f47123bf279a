"""Platforms by name and by pattern."""

import pytest

from linepose.config.platform_patterns import fits, named_platforms
from linepose.errors import InputError


@pytest.fixture
def folder(tmp_path):
    for name in ("fleet-2", "fleet-1", "fleet-10", "other"):
        (tmp_path / f"{name}.yaml").touch()
    return tmp_path


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        (["fleet-*"], ["fleet-1", "fleet-10", "fleet-2"]),
        (["other", "fleet-?"], ["other", "fleet-1", "fleet-2"]),
        (["fleet-10", "fleet-*"], ["fleet-10", "fleet-1", "fleet-2"]),
        (["*1", "fleet-[12]"], ["fleet-1", "fleet-2"]),
        (["not-there"], ["not-there"]),  # which loading it tells
    ],
)
def test_patterns_name_files_once_in_their_place(folder, given, expected):
    assert named_platforms(given, folder) == expected


@pytest.mark.parametrize(
    ("given", "told"),
    [
        (["tractor-*"], r"platforms: found 'tractor-\*', which fits no file .*pattern of fleet-1, fleet-10"),
        (["other", "fleet-*", "other"], "platforms: found other twice"),
    ],
)
def test_pattern_of_nothing_and_name_twice_are_refused(folder, given, told):
    with pytest.raises(InputError, match=told):
        named_platforms(given, folder)


def test_name_that_no_file_can_have_is_told_with_the_place_that_says_it(folder):
    with pytest.raises(
        InputError, match=r"config.yaml: platforms: found .fleet-1 no., expected letters, digits, - and _"
    ):
        named_platforms(["fleet-1 no"], folder)


def test_only_signs_make_a_pattern():
    assert fits("fleet-1", "fleet-*")
    assert fits("fleet-1", "fleet-1")
    assert not fits("fleet-1", "fleet")
    assert not fits("Fleet-1", "fleet-*")
