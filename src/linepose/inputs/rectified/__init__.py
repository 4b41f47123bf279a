"""Scans on a plane or flat ground at the pose at hand, with the way back to raw pixels and lines."""

from pathlib import Path

from linepose.compiling.cache import forget_outdated

forget_outdated(Path(__file__).parent)
