"""The searches that can be chosen by name; each one takes a likelihood, a start pose (6,) and the search's limits."""

from collections.abc import Callable
from typing import Final

import numpy as np

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.estimation.optimise import Optimum, Search, optimise, optimise_within
from linepose.estimation.wide_search import search_widely
from linepose.geometry.pose import N_PARAMETERS, check_pose
from linepose.likelihood.base import Likelihood

Optimiser = Callable[[Likelihood, Floats, Search], Optimum]


def search_as_published(likelihood: Likelihood, start: Floats, search: Search) -> Optimum:
    """Powell's method on the paper's equations, in which points behind the camera count as if in front.

    The rotation vector's components stay within +- pi, wherever the search starts; the position stays near the start.
    This reproduces the basin of section 4.7. `optimise` excludes points behind the camera, which widens it, and centres
    all ranges on the start, so that a camera turned by half a revolution is as well off as any other.
    """
    first = likelihood.start(check_pose(start, "start pose"))
    centre = first.copy()
    centre[3:N_PARAMETERS] = 0.0
    half_width = likelihood.half_widths(search.half_width_m, np.pi)
    return optimise_within(likelihood.without_cheirality(), first, centre, half_width, search)


OPTIMISERS: Final[dict[str, Optimiser]] = {
    "powell": search_as_published,
    "powell_in_front": optimise,
    "wide": search_widely,
}


def optimiser(name: str) -> Optimiser:
    """The search of this name; raises InputError for an unknown one."""
    if name not in OPTIMISERS:
        raise InputError("basin.optimisers", f"{name!r}", f"one of {', '.join(OPTIMISERS)}", "correct the name")
    return OPTIMISERS[name]
