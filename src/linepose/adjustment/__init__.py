"""The adjustment: camera pose, points and body poses together, the scales of their errors estimated from the same data.

`adjust` is what a user calls. Mathematics first: `process` says what the errors are, `whitening` makes measurements
independent, `normal` and `solve` find the minimum of chi squared, `reml` the levels, `curvature` and `posterior` how
sure the pose is. Names are imported when they are first used: configuration needs the settings only.
"""

from pathlib import Path

import lazy_loader

from linepose import geometry
from linepose.compiling.cache import forget_outdated

forget_outdated(Path(__file__).parent, [Path(geometry.__file__).parent / "lens.py"])

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
