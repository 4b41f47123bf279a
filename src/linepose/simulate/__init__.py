"""Surveys with a known truth: what a platform would record."""

from pathlib import Path

from linepose import pattern
from linepose.compiled_cache import forget_outdated

forget_outdated(Path(__file__).parent, [Path(pattern.__file__)])
