"""What a figure is: one entry, beside the function that draws it."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import pyarrow as pa
from matplotlib.figure import Figure

from linepose.config.platform import Platform
from linepose.estimation.noise_models import noise_model
from linepose.experiments.registry import SECTIONS
from linepose.pipeline.calibration import Calibration
from linepose.tables import texts

FIGURES: Final = pa.schema(texts("figure", "title", "caption", "alt", "left_out"))


@dataclass(frozen=True)
class FigureEntry:
    """One figure: file stem, title, what it shows, and how it is made.

    `needs` names the results that it is drawn from, as far as the platform has them. `left_out` says in a sentence why
    a platform has none of it, and is empty where it should have one.
    """

    name: str
    title: str
    shows: str
    needs: tuple[str, ...]
    draw: Callable[[Calibration], Figure]
    caption: Callable[[Calibration], str]
    left_out: Callable[[Platform], str] = lambda _: ""


def without(key: str) -> Callable[[Platform], str]:
    """Why a platform has no figure of the experiment of this key: it was not asked for."""
    told = f"This experiment was not asked for: experiments.{key} is null in the platform's file."
    return lambda platform: "" if SECTIONS[key].of(platform) else told


def without_removal(told: str) -> Callable[[Platform], str]:
    """Why a platform whose noise model removes no observation has no such figure: `told`."""
    return lambda platform: "" if noise_model(platform.noise_model).removes_outliers else told
