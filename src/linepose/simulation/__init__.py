"""Surveys with a known truth: what a platform would record."""

from pathlib import Path

from linepose.compiling.cache import forget_outdated
from linepose.survey import pattern

forget_outdated(Path(__file__).parent, [Path(pattern.__file__)])
