"""linepose: the pose of a line-scan camera on a vehicle, and how sure it is.

The names below are imported when they are first used, so that `import linepose` costs nothing.
"""

from importlib import import_module
from typing import Any

_HOMES = {
    "Camera": "geometry.camera",
    "CameraSigmas": "geometry.camera",
    "Calibration": "pipeline.calibration",
    "HandMeasured": "survey.hand_measured",
    "CalibrationSettings": "pipeline.calibrate",
    "calibrate": "pipeline.calibrate",
    "calibrate_platform": "pipeline.api",
    "load_observations": "pipeline.api",
    "load_platform_file": "pipeline.api",
    "observations_from_arrays": "pipeline.api",
    "check_platform": "check.platform",
    "SamplingSettings": "estimation.sampling",
    "IndependenceSettings": "estimation.sampling",
    "Search": "estimation.optimise",
    "LineposeError": "errors",
    "InputError": "errors",
    "EstimationError": "errors",
}

__all__ = sorted(_HOMES)


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from importlib.metadata import version

        return version(__name__)
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *_HOMES})
