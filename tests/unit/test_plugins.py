"""Entry points: members of this package and of others, by their names."""

import importlib
import sys

import pytest

from linepose.errors import InputError
from linepose.pipeline.exports.format import ExportFormat
from linepose.pipeline.exports.registry import EXPORTS
from linepose.plugins import PluginGroup

CODE = """
from linepose.pipeline.exports.format import ExportFormat

FORMAT = ExportFormat("foreign", "name alone", ".txt", lambda calibration, options, path: path.write_text("x"))
"""


@pytest.fixture
def foreign(tmp_path, monkeypatch):
    """Another package that brings a format of export, and one under another name than its own."""
    information = tmp_path / "foreign_package-1.dist-info"
    information.mkdir()
    (tmp_path / "foreign_package.py").write_text(CODE)
    (information / "METADATA").write_text("Metadata-Version: 2.1\nName: foreign-package\nVersion: 1\n")
    entries = "foreign = foreign_package:FORMAT\nmisnamed = foreign_package:FORMAT\n"
    (information / "entry_points.txt").write_text(f"[linepose.exports]\n{entries}")
    monkeypatch.syspath_prepend(str(tmp_path))
    importlib.invalidate_caches()
    yield
    sys.modules.pop("foreign_package", None)


def test_members_of_other_packages_are_found_beside_our_own(foreign):
    assert EXPORTS.member("foreign").suffix == ".txt"
    assert set(EXPORTS.names()) == {one.name for one in EXPORTS.own()} | {"foreign", "misnamed"}


def test_member_under_another_name_is_told(foreign):
    told = r"entry point misnamed of linepose.exports: found .*, expected an ExportFormat named misnamed"
    with pytest.raises(InputError, match=told):
        EXPORTS.member("misnamed")


def test_group_that_was_never_installed_is_told():
    group = PluginGroup("linepose.not_installed", ExportFormat, "format")
    with pytest.raises(InputError, match=r"linepose.not_installed: found none, .*; install linepose again"):
        group.names()
