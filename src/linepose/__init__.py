"""linepose: the pose of a line-scan camera on a vehicle, and how sure it is.

The names below are imported when they are first used, so that `import linepose` costs nothing.
"""

from typing import Any

import lazy_loader

_import, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from importlib.metadata import version

        return version(__name__)
    return _import(name)
