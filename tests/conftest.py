"""Which tests run in one process: those of a file, and all that start from the workflow's finished run."""

import pytest


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Group tests that share fixtures, so that none is made twice; the long ones, of the workflow, begin first."""
    items.sort(key=lambda item: "workflow" not in item.path.parts)
    for item in items:
        group = "finished" if "finished" in getattr(item, "fixturenames", ()) else str(item.path)
        item.add_marker(pytest.mark.xdist_group(group))
