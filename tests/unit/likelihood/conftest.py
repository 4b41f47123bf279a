import pytest

from linepose.survey.observations import Survey
from unit.likelihood import surveys


@pytest.fixture(scope="session")
def field_survey() -> Survey:
    if not surveys.FIELD_FOLDER.is_dir():
        pytest.skip(f"no field data in {surveys.FIELD_FOLDER.name}")
    return surveys.field_survey()
