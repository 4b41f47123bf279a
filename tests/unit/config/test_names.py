import pytest

from linepose.config.names import check_name
from linepose.config.platform import platform_faults
from linepose.config.study import DatasetSection
from linepose.errors import InputError
from linepose.settings import validated

SUM = "0" * 64


@pytest.mark.parametrize("name", ["two words", "a/b", "../a", "logs", "tables", "Coverage", "{a}", "", "-x", ".", "a."])
def test_name_that_no_rule_can_have_is_refused_by_check_as_by_run(name, tmp_path):
    with pytest.raises(InputError):
        check_name(name)
    assert len(platform_faults(tmp_path, name)) == 1


@pytest.mark.parametrize("name", ["robot", "robot-2", "a_b", "robot.v2"])
def test_name_that_all_can_have(name):
    assert check_name(name) == name


@pytest.mark.parametrize("file", ["../../../F", "/etc/F", "a/../../F", "", "a\\..\\F", "a\nb"])
def test_data_set_s_files_stay_in_its_folder(file):
    with pytest.raises(InputError, match="paths below the data set's folder"):
        validated(DatasetSection, {"base_url": "https://example.org/", "sha256": {file: SUM}}, "data.yaml")
