"""Noise models of the reprojected points (Eq. 11-22): each a file, all behind one class."""

from pathlib import Path

from linepose.compiling.cache import forget_outdated

forget_outdated(Path(__file__).parent)
