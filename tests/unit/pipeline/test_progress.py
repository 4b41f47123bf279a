import pytest

from linepose.pipeline.progress import shown


@pytest.mark.parametrize(
    ("terminal", "ci", "expected"),
    [(True, None, True), (True, "", True), (True, "true", False), (False, None, False), (False, "true", False)],
)
def test_shown_to_people_only(monkeypatch, terminal, ci, expected):
    monkeypatch.setattr("sys.stderr.isatty", lambda: terminal, raising=False)
    monkeypatch.delenv("CI", raising=False)
    if ci is not None:
        monkeypatch.setenv("CI", ci)
    assert shown() is expected
