"""The searches that can be chosen by name; each one takes a likelihood, a start pose (6,) and the search's limits."""

from collections.abc import Callable
from typing import Final

from linepose.errors import InputError
from linepose.likelihood.base import Likelihood
from linepose.optimise import Optimum, Search, optimise
from linepose.rotations import Floats

Optimiser = Callable[[Likelihood, Floats, Search], Optimum]

OPTIMISERS: Final[dict[str, Optimiser]] = {"powell": optimise}


def optimiser(name: str) -> Optimiser:
    """The search of this name; raises InputError for an unknown one."""
    if name not in OPTIMISERS:
        raise InputError("basin.optimisers", f"{name!r}", f"one of {', '.join(OPTIMISERS)}", "correct the name")
    return OPTIMISERS[name]
