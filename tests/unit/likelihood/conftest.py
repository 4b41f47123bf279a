import pytest
import surveys

from linepose.observations import Survey


@pytest.fixture(scope="session")
def field_survey() -> Survey:
    if not surveys.FIELD_FOLDER.is_dir():
        pytest.skip(f"no field data in {surveys.FIELD_FOLDER.name}")
    return surveys.field_survey()
