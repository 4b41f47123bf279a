"""In which order tests run: the long ones, of the workflow, begin first."""

import pytest


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Put the workflow's tests first; the tests of a file stay together, so that what they share is made once."""
    items.sort(key=lambda item: "workflow" not in item.path.parts)
