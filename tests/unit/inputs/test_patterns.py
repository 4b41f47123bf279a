import os

import pytest

from linepose.errors import InputError
from linepose.inputs.patterns import is_of, matching
from linepose.inputs.source import ScansSection
from linepose.settings import validated


@pytest.mark.parametrize(
    "pattern", ["", "/data/*.hdr", "../scans/*.hdr", "scans/{a}.hdr", "a\x00b", "a**b/*.hdr", ".", "x" * 2000]
)
@pytest.mark.parametrize("key", ["scans", "labels", "navigation", "covariances"])
def test_pattern_that_the_run_cannot_use_is_refused(key, pattern):
    with pytest.raises(InputError, match=f"source.yaml: {key}"):
        validated(ScansSection, {"kind": "scans", "dataset": "own", key: pattern}, "source.yaml")


@pytest.mark.parametrize("name", ["two words", "../own", "/own", "own/{a}", ""])
def test_data_set_is_the_name_of_a_folder(name):
    with pytest.raises(InputError, match="the name of a folder"):
        validated(ScansSection, {"kind": "scans", "dataset": name}, "source.yaml")


def test_a_file_with_signs_of_patterns_is_found_by_its_name(tmp_path):
    for name in ("run[1].hdr", "run1.hdr"):
        (tmp_path / name).touch()
    assert matching(tmp_path, "run[1].hdr") == [tmp_path / "run[1].hdr"]
    assert matching(tmp_path, "*.hdr") == [tmp_path / "run1.hdr", tmp_path / "run[1].hdr"]


@pytest.mark.parametrize(
    ("pattern", "is_found"),
    [
        ("scans/strip-01.hdr", True),
        ("./scans/*.hdr", True),
        ("scans//strip-0[1-3].hdr", True),
        ("scans/**/*.hdr", True),
        ("**/strip-01.hdr", True),
        ("**/**/*.hdr", True),
        ("s*/strip-??.hdr", True),
        ("*.hdr", False),
        ("*-01.hdr", False),
        ("scans*", False),
        ("scans/*/*.hdr", False),
        ("**/scans", False),
        ("Scans/*.hdr", False),
        ("scans/strip-01.hdr/*", False),
    ],
)
def test_a_name_fits_a_pattern_as_its_file_is_found(tmp_path, pattern, is_found):
    """With what the file system says as the reference."""
    (tmp_path / "scans").mkdir()
    file = tmp_path / "scans" / "strip-01.hdr"
    file.touch()
    assert (file in matching(tmp_path, pattern)) == is_found
    assert is_of("scans/strip-01.hdr", pattern) == is_found


def test_a_name_with_signs_of_patterns_fits_itself():
    assert is_of("run[1].hdr", "run[1].hdr")
    assert is_of("run1.hdr", "run[1].hdr")


def test_a_file_with_braces_is_told(tmp_path):
    (tmp_path / "run{1}.hdr").touch()
    with pytest.raises(InputError, match="rename the file"):
        matching(tmp_path, "*.hdr")


def test_a_pipe_is_told_before_it_is_read(tmp_path):
    os.mkfifo(tmp_path / "run.hdr")
    for pattern in ("run.hdr", "*.hdr"):
        with pytest.raises(InputError, match=r"run.hdr: found a device or pipe, expected a file"):
            matching(tmp_path, pattern)


def test_a_file_that_may_not_be_read_is_told(tmp_path, monkeypatch):
    (tmp_path / "run.hdr").touch()
    monkeypatch.setattr(os, "access", lambda path, mode: False)
    for pattern in ("run.hdr", "*.hdr"):
        with pytest.raises(InputError, match=r"run.hdr: found a file that may not be read"):
            matching(tmp_path, pattern)
